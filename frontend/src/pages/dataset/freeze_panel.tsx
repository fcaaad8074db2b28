import { useQuery, useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { Link, useNavigate } from "react-router";
import { freezeSplit } from "../../api/board_endpoints";
import { boardKeys } from "../../api/board_queries";
import { listImages } from "../../api/endpoints";
import { asProblem } from "../../api/problem";
import { keys } from "../../api/queries";
import type { Dataset } from "../../api/types";
import { Button } from "../../design/button";
import { Ellipsis } from "../../design/ellipsis";
import { formatCount, formatQuantity, sentence } from "../../design/format";
import { Icon } from "../../design/icons";
import { Segmented } from "../../design/segmented";
import { toast } from "../../design/toast";
import { type FreezeFields, NEW_SPLIT, newSplit } from "./freeze_form";

const NAMES_SHOWN = 6;

/** Freezes the labels of a dataset's images: what is in, what isn't done yet, and under which terms. */
export function FreezePanel({ dataset, close }: { dataset: Dataset; close: () => void }) {
  const client = useQueryClient();
  const navigate = useNavigate();
  const [fields, setFields] = useState(NEW_SPLIT);
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<string | null>(null);
  const set = (changes: Partial<FreezeFields>) => setFields({ ...fields, ...changes });
  const { done } = dataset.reviewed;

  const submit = async (event: FormEvent) => {
    event.preventDefault();
    setBusy(true);
    try {
      const split = await freezeSplit(dataset.slug, newSplit(fields));
      await client.invalidateQueries({ queryKey: boardKeys.splits });
      toast({ tone: "success", message: `${split.name} is frozen.` });
      navigate(`/splits/${split.slug}`);
    } catch (error) {
      const { message, expected, hint } = asProblem(error);
      setProblem(
        [message, expected ? `expected: ${expected}` : null, hint]
          .flatMap((text) => (text ? [sentence(text)] : []))
          .join(" "),
      );
      setBusy(false);
    }
  };

  return (
    <form
      className="freeze-panel card"
      aria-label="Freeze a split"
      onSubmit={submit}
      onKeyDown={(event) => {
        if (event.key !== "Escape") return;
        event.stopPropagation();
        close();
      }}
    >
      <Preview dataset={dataset} />
      <div className="freeze-panel__fields">
        <label className="field freeze-panel__name">
          <span className="field__label">Name</span>
          <input
            className="input"
            // biome-ignore lint/a11y/noAutofocus: the panel was opened to fill it in
            autoFocus
            required
            maxLength={200}
            placeholder={`${dataset.name} test`}
            value={fields.name}
            onChange={(event) => set({ name: event.target.value })}
          />
        </label>
        <div className="field">
          <span className="field__label">Labels</span>
          <Segmented
            label="Labels"
            name="split-visibility"
            value={fields.visibility}
            onChange={(visibility) => set({ visibility })}
            choices={[
              { value: "open", label: "Open" },
              { value: "hidden", label: "Hidden" },
            ]}
          />
        </div>
        <label className="field">
          <span className="field__label">Minimum length, px</span>
          <input
            className="input numeric"
            type="number"
            required
            min={0}
            max={100_000}
            step="any"
            value={fields.minLength}
            onChange={(event) => set({ minLength: event.target.value })}
          />
        </label>
        <label className="field">
          <span className="field__label">Deadline</span>
          <input
            className="input"
            type="datetime-local"
            value={fields.closesAt}
            onChange={(event) => set({ closesAt: event.target.value })}
          />
        </label>
        <label className="field">
          <span className="field__label">Scored per day and person</span>
          <input
            className="input numeric"
            type="number"
            min={1}
            max={100_000}
            placeholder={fields.visibility === "open" ? "20" : "5"}
            value={fields.dailyLimit}
            onChange={(event) => set({ dailyLimit: event.target.value })}
          />
        </label>
        <label className="field freeze-panel__wide">
          <span className="field__label">Description</span>
          <input
            className="input"
            maxLength={2_000}
            placeholder="What the images show, who labelled them"
            value={fields.description}
            onChange={(event) => set({ description: event.target.value })}
          />
        </label>
      </div>
      <p className="muted freeze-panel__meaning">
        {fields.visibility === "open"
          ? "Open: everyone may download the labels and see each result image by image."
          : "Hidden: below maintainer nobody sees the labels, the dataset's segments of these images, or anything of a result but its rounded totals."}{" "}
        Shorter labels than the minimum are neither asked for nor counted.
      </p>
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
      <div className="freeze-panel__actions">
        <Button type="submit" tone="primary" icon="snow" busy={busy} disabled={done === 0}>
          Freeze {formatQuantity(done, "image")}
        </Button>
        <Button tone="quiet" onClick={close}>
          Cancel
        </Button>
      </div>
    </form>
  );
}

/** What would be frozen, and what stays out because nobody has finished it. */
function Preview({ dataset }: { dataset: Dataset }) {
  const { slug, reviewed, verdicts } = dataset;
  const { done, open, discarded } = reviewed;
  const first = useQuery({
    queryKey: [...keys.images(slug), "not-done"],
    queryFn: () => listImages(slug, { status: "open", sort: "name" }, null, NAMES_SHOWN),
    enabled: open > 0,
  });
  return (
    <div className="freeze-preview">
      <div>
        <h2>
          <Icon name="check" /> Goes in
        </h2>
        <p className="numeric">
          <strong>{formatQuantity(done, "image")}</strong> whose review is done
        </p>
        <p className="muted numeric">
          {formatCount(verdicts.keep)} kept
          {verdicts.ambiguous > 0 ? `, ${formatCount(verdicts.ambiguous)} ambiguous (never scored)` : ""} in
          the dataset
        </p>
      </div>
      <div>
        <h2>
          <Icon name={open > 0 ? "warning" : "check"} /> Stays out
        </h2>
        {open === 0 && discarded === 0 ? <p className="muted">Nothing: every image is done.</p> : null}
        {open > 0 ? (
          <>
            <p className="numeric">
              <Link to="?status=open">{formatQuantity(open, "image")} not done yet</Link>
            </p>
            <ul className="muted freeze-preview__names">
              {first.data?.items.map(({ id, name }) => (
                <li key={id}>
                  <Link to={`/datasets/${slug}/images/${id}`}>
                    <Ellipsis text={name} end={14} />
                  </Link>
                </li>
              ))}
              {open > NAMES_SHOWN ? <li>and {formatCount(open - NAMES_SHOWN)} more</li> : null}
            </ul>
          </>
        ) : null}
        {discarded > 0 ? (
          <p className="muted numeric">{formatQuantity(discarded, "image")} discarded</p>
        ) : null}
      </div>
    </div>
  );
}
