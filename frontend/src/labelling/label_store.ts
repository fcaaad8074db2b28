/** The state of one image under review, and everything that can be done to it. */

import type { NewDecision, SegmentFacts, StoredDecision, Verdict } from "../api/types";
import { type CaughtUp, caughtUp } from "./catch_up";
import { type ChangeGroup, type History, pushed, redone, undone, type VerdictChange } from "./history";
import { isShown, type LabelState, SHOW_ALL, type Shown, verdictAt } from "./label_state";
import { nextInSequence, type ReviewOrder, reviewSequence } from "./order";
import type { Stopwatch } from "./stopwatch";
import { countVerdicts } from "./verdicts";

interface StoreParts {
  candidates: readonly SegmentFacts[];
  verdicts: readonly Verdict[];
  history: History;
  imageHeight: number;
  order: ReviewOrder;
  shown?: Shown;
  stopwatch: Stopwatch;
  newId: () => string;
  /** Takes the decisions to where they can't be lost. */
  record: (decisions: NewDecision[]) => void;
}

type Kind = NewDecision["kind"];

export class LabelStore {
  private readonly parts: StoreParts;
  private readonly indexOf: ReadonlyMap<number, number>;
  private readonly listeners = new Set<() => void>();
  private state: LabelState;
  /** Where the review goes on when nothing is selected: a click beside a line doesn't lose one's place. */
  private place: number | null = null;

  constructor(parts: StoreParts) {
    this.parts = parts;
    this.indexOf = new Map(parts.candidates.map((candidate, index) => [candidate.id, index]));
    this.state = {
      candidates: parts.candidates,
      verdicts: parts.verdicts,
      counts: countVerdicts(parts.verdicts),
      sequence: reviewSequence(parts.candidates, parts.order, parts.imageHeight),
      order: parts.order,
      selected: null,
      shown: parts.shown ?? SHOW_ALL,
      history: parts.history,
      followRequest: 0,
    };
  }

  readonly getState = (): LabelState => this.state;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  indexOfSegment(segmentId: number): number | null {
    return this.indexOf.get(segmentId) ?? null;
  }

  select(index: number | null, { follow = false } = {}): void {
    if (index !== this.state.selected) this.parts.stopwatch.restart();
    if (index !== null) this.place = index;
    const { followRequest } = this.state;
    this.set({ selected: index, followRequest: follow ? followRequest + 1 : followRequest });
  }

  /** Selects the next (or previous) candidate that is shown. */
  step(direction: 1 | -1): void {
    const { sequence, selected } = this.state;
    const next = nextInSequence(sequence, selected ?? this.place, direction, this.shownAt);
    if (next !== null) this.select(next, { follow: true });
  }

  /** Selects the first undecided candidate in the order of review; false where none is left. */
  selectFirstUndecided(): boolean {
    const first = nextInSequence(this.state.sequence, null, 1, this.undecidedAt);
    if (first !== null) this.select(first, { follow: true });
    return first !== null;
  }

  /** Gives the selected candidate a verdict and goes to the next undecided one. */
  judgeSelected(verdict: Verdict): void {
    const { selected } = this.state;
    if (selected === null) return;
    const changed = this.judge([selected], verdict);
    if (verdict === "undecided") return;
    if (changed || verdictAt(this.state, selected) === verdict) this.advance(selected);
  }

  /** Rejects all that is undecided, shown or not; gives their number. */
  rejectUndecided(): number {
    const undecided = this.state.sequence.filter(this.undecidedAt);
    this.judge(undecided, "reject");
    return undecided.length;
  }

  /** One verdict for several candidates, undone by one undo. */
  judge(indices: readonly number[], verdict: Verdict): boolean {
    const changes = indices
      .map((index) => this.changeOf(index, verdict))
      .filter((change) => change.from !== change.to);
    if (changes.length === 0) return false;
    const group: ChangeGroup = { id: this.parts.newId(), changes };
    this.apply(changes, "judge", group.id);
    this.set({ history: pushed(this.state.history, group) });
    return true;
  }

  /** Takes the latest group of changes back; gives it, or null where there is none. */
  undo(): ChangeGroup | null {
    return this.replay("undo");
  }

  redo(): ChangeGroup | null {
    return this.replay("redo");
  }

  /**
   * Takes over the history from the server, with what was decided in another tab or by another person since.
   *
   * @param decisions All of the image as the server has them, oldest first.
   * @param unsent Those of here that aren't among them.
   */
  catchUp(decisions: readonly StoredDecision[], unsent: readonly NewDecision[]): CaughtUp {
    const caught = caughtUp(this.state, this.indexOf, decisions, unsent);
    const { changed, verdicts, history } = caught;
    this.set(changed.length > 0 ? { verdicts, history, counts: countVerdicts(verdicts) } : { history });
    return caught;
  }

  setShown(shown: Shown): void {
    this.set({ shown });
    const { selected } = this.state;
    if (selected !== null && !isShown(this.state, selected)) this.select(null);
  }

  setOrder(order: ReviewOrder): void {
    const sequence = reviewSequence(this.state.candidates, order, this.parts.imageHeight);
    this.set({ order, sequence });
  }

  private readonly shownAt = (index: number): boolean => isShown(this.state, index);
  private readonly undecidedAt = (index: number): boolean => verdictAt(this.state, index) === "undecided";

  private advance(from: number): void {
    const wanted = (index: number) => this.undecidedAt(index) && this.shownAt(index);
    const next = nextInSequence(this.state.sequence, from, 1, wanted);
    if (next !== null) this.select(next, { follow: true });
  }

  private replay(kind: "undo" | "redo"): ChangeGroup | null {
    const { history } = this.state;
    const group = kind === "undo" ? history.done.at(-1) : history.undone.at(-1);
    if (group === undefined) return null;
    const changes = kind === "undo" ? group.changes.map(reversed) : group.changes;
    this.apply(changes, kind, this.parts.newId(), group.id);
    this.set({ history: kind === "undo" ? undone(history) : redone(history) });
    const [only, ...others] = group.changes;
    const index = only === undefined || others.length > 0 ? null : this.indexOfSegment(only.segmentId);
    if (index !== null) this.select(index, { follow: true });
    return group;
  }

  private changeOf(index: number, to: Verdict): VerdictChange {
    const candidate = this.state.candidates[index];
    if (candidate === undefined) throw new RangeError(`There is no candidate ${index}.`);
    return { segmentId: candidate.id, from: verdictAt(this.state, index), to };
  }

  private apply(
    changes: readonly VerdictChange[],
    kind: Kind,
    groupId: string,
    targetGroupId?: string,
  ): void {
    const elapsed = this.parts.stopwatch.read();
    const verdicts = [...this.state.verdicts];
    for (const { segmentId, to } of changes) {
      const index = this.indexOfSegment(segmentId);
      if (index !== null) verdicts[index] = to;
    }
    this.parts.record(
      changes.map(({ segmentId, to }) => ({
        client_id: this.parts.newId(),
        group_id: groupId,
        kind,
        ...(targetGroupId === undefined ? {} : { target_group_id: targetGroupId }),
        segment_id: segmentId,
        verdict: to,
        elapsed_ms: elapsed,
      })),
    );
    this.parts.stopwatch.restart();
    this.set({ verdicts, counts: countVerdicts(verdicts) });
  }

  private set(part: Partial<LabelState>): void {
    this.state = { ...this.state, ...part };
    for (const listener of [...this.listeners]) listener();
  }
}

function reversed({ segmentId, from, to }: VerdictChange): VerdictChange {
  return { segmentId, from: to, to: from };
}
