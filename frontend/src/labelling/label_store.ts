/** The state of one image under review, and everything that can be done to it. */

import type { NewDecision, RejectReason, SegmentFacts, StoredDecision, Verdict } from "../api/types";
import { type CaughtUp, caughtUp } from "./catch_up";
import { type ChangeGroup, type History, pushed, redone, undone, type VerdictChange } from "./history";
import { type Act, changed, decisionsOf, type Given, type JudgeOptions, judgedBy, reversed } from "./judging";
import { isShown, type LabelState, SHOW_ALL, type Shown } from "./label_state";
import { type ReviewOrder, reviewSequence } from "./order";
import {
  firstUndecided,
  isUndecided,
  NOTHING_SELECTED,
  nextShown,
  nextToJudge,
  type Selection,
  selectionOf,
  selectionOfOne,
  toggledSelection,
} from "./selection";
import type { Stopwatch } from "./stopwatch";
import { suggestedVerdicts } from "./suggestions/accepting";
import { NOT_SUGGESTING, type Suggesting, sameSuggesting, sameSuggestions } from "./suggestions/suggestions";
import { countVerdicts } from "./verdicts";

interface StoreParts {
  candidates: readonly SegmentFacts[];
  verdicts: readonly Verdict[];
  reasons: readonly (RejectReason | null)[];
  history: History;
  imageHeight: number;
  order: ReviewOrder;
  shown?: Shown;
  stopwatch: Stopwatch;
  newId: () => string;
  /** Takes the decisions to where they can't be lost. */
  record: (decisions: NewDecision[]) => void;
}

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
      reasons: parts.reasons,
      counts: countVerdicts(parts.verdicts),
      sequence: reviewSequence(parts.candidates, parts.order, parts.imageHeight),
      order: parts.order,
      ...NOTHING_SELECTED,
      shown: parts.shown ?? SHOW_ALL,
      suggesting: NOT_SUGGESTING,
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

  /** @param follow Whether the view goes to it. */
  select(index: number | null, { follow = false } = {}): void {
    this.choose(index === null ? NOTHING_SELECTED : selectionOfOne(index), follow);
  }

  /** Selects exactly these; the panel shows the first of them in the order of review. */
  selectAll(indices: Iterable<number>): void {
    this.choose(selectionOf(this.state, indices));
  }

  /** Adds a candidate to the selection, or takes it out of it. */
  toggleSelected(index: number): void {
    this.choose(toggledSelection(this.state, index));
  }

  /** Selects the next (or previous) candidate that is shown. */
  step(direction: 1 | -1): void {
    this.goTo(nextShown(this.state, this.state.selected ?? this.place, direction));
  }

  /** Selects the first undecided candidate in the order of review; false where none is left. */
  selectFirstUndecided(): boolean {
    return this.goTo(firstUndecided(this.state));
  }

  /** Gives all that is selected a verdict, as one group, and goes to the next undecided candidate. */
  judgeSelected(verdict: Verdict, given: JudgeOptions = {}): boolean {
    const { selected, selection } = this.state;
    if (selected === null) return false;
    const judged = this.judge(selection, verdict, given);
    if (verdict !== "undecided") this.goTo(nextToJudge(this.state, selected));
    return judged;
  }

  /** Rejects all that is undecided, shown or not; gives their number. */
  rejectUndecided(): number {
    const undecided = this.state.sequence.filter((index) => isUndecided(this.state, index));
    this.judge(undecided, "reject");
    return undecided.length;
  }

  /** One verdict for several candidates, undone by one undo. */
  judge(indices: readonly number[], verdict: Verdict, { reason, kind }: JudgeOptions = {}): boolean {
    return this.decide(
      indices.map((index) => ({ index, verdict, reason })),
      kind,
    );
  }

  /** Several judgements that are undone by one undo; false where nothing changes. */
  decide(given: readonly Given[], kind: JudgeOptions["kind"] = "judge"): boolean {
    const { changes, suggestions } = judgedBy(this.state, given);
    if (changes.length === 0) return false;
    const group: ChangeGroup = { id: this.parts.newId(), changes };
    this.apply(changes, { kind, groupId: group.id, suggestions });
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
   * @param edited Segments that edits by hand added or replaced.
   */
  catchUp(
    decisions: readonly StoredDecision[],
    unsent: readonly NewDecision[],
    edited?: ReadonlySet<number>,
  ): CaughtUp {
    const caught = caughtUp(this.state, this.indexOf, decisions, unsent, edited);
    const { verdicts, reasons, history } = caught;
    this.set(
      caught.changed.length > 0
        ? { verdicts, reasons, history, counts: countVerdicts(verdicts) }
        : { history },
    );
    return caught;
  }

  setShown(shown: Shown): void {
    this.set({ shown });
    const { selection } = this.state;
    const left = selection.filter((index) => isShown(this.state, index));
    if (left.length < selection.length) this.selectAll(left);
  }

  setOrder(order: ReviewOrder): void {
    this.set({ order, sequence: this.sequenceOf(order, this.state.suggesting) });
  }

  setSuggesting(suggesting: Suggesting): void {
    if (sameSuggesting(suggesting, this.state.suggesting)) return;
    const known = sameSuggestions(suggesting, this.state.suggesting);
    const sequence = known ? this.state.sequence : this.sequenceOf(this.state.order, suggesting);
    this.set({ suggesting, sequence });
  }

  /** Decides the undecided among some candidates as suggested, as one group; gives how many are kept and rejected. */
  acceptSuggested(indices: readonly number[]): { keep: number; reject: number } {
    const given = suggestedVerdicts(this.state, indices);
    const { selected } = this.state;
    this.decide(given, "accept");
    if (selected !== null && given.some(({ index }) => index === selected)) {
      this.goTo(nextToJudge(this.state, selected));
    }
    const count = (wanted: Verdict) => given.filter(({ verdict }) => verdict === wanted).length;
    return { keep: count("keep"), reject: count("reject") };
  }

  private choose(next: Selection, follow = false): void {
    if (next.selected !== this.state.selected) this.parts.stopwatch.restart();
    if (next.selected !== null) this.place = next.selected;
    const { followRequest } = this.state;
    this.set({ ...next, followRequest: follow ? followRequest + 1 : followRequest });
  }

  /** Selects a candidate and has the view follow; false where there is none. */
  private goTo(index: number | null): boolean {
    if (index !== null) this.select(index, { follow: true });
    return index !== null;
  }

  private sequenceOf(order: ReviewOrder, suggesting: Suggesting): number[] {
    return reviewSequence(this.parts.candidates, order, this.parts.imageHeight, suggesting.of);
  }

  private replay(kind: "undo" | "redo"): ChangeGroup | null {
    const { history } = this.state;
    const group = kind === "undo" ? history.done.at(-1) : history.undone.at(-1);
    if (group === undefined) return null;
    const changes = kind === "undo" ? group.changes.map(reversed) : group.changes;
    this.apply(changes, { kind, groupId: this.parts.newId(), targetGroupId: group.id });
    this.set({ history: kind === "undo" ? undone(history) : redone(history) });
    const [only, ...others] = group.changes;
    if (only !== undefined && others.length === 0) this.goTo(this.indexOfSegment(only.segmentId));
    return group;
  }

  private apply(changes: readonly VerdictChange[], act: Act): void {
    const { stopwatch, newId, record } = this.parts;
    record(decisionsOf(changes, act, stopwatch.read(), newId));
    stopwatch.restart();
    this.set(changed(this.state, this.indexOf, changes));
  }

  private set(part: Partial<LabelState>): void {
    this.state = { ...this.state, ...part };
    for (const listener of [...this.listeners]) listener();
  }
}
