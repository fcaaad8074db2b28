import { useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { asProblem } from "../../../api/problem";
import { keys } from "../../../api/queries";
import { changeGuidelines, type Guidelines, teamKeys } from "../../../api/team_endpoints";
import { Button } from "../../../design/button";
import { toast } from "../../../design/toast";

const LONGEST = 20_000;

interface GuidelinesSectionProps {
  slug: string;
  guidelines: Guidelines;
  editable: boolean;
}

/** What annotators read and are asked. */
export function GuidelinesSection({ slug, guidelines, editable }: GuidelinesSectionProps) {
  const [editing, setEditing] = useState(false);
  const { rules } = guidelines;
  return (
    <section className="section card" aria-labelledby="guidelines-title">
      <header className="section__header">
        <h2 id="guidelines-title">Guidelines and rules</h2>
        {editable && !editing ? (
          <Button small icon="pencil" onClick={() => setEditing(true)}>
            Edit
          </Button>
        ) : null}
      </header>
      {editing ? (
        <GuidelinesForm slug={slug} guidelines={guidelines} close={() => setEditing(false)} />
      ) : (
        <>
          {guidelines.guidelines ? (
            <p className="team__guidelines">{guidelines.guidelines}</p>
          ) : (
            <p className="muted">
              No guidelines yet. What counts as a straight line, what is to be called ambiguous? Annotators
              read them beside the image with Shift+G.
            </p>
          )}
          <ul className="team__rules">
            <li>
              {rules.second_share > 0
                ? `${Math.round(100 * rules.second_share)} % of the images are reviewed a second time, blindly.`
                : "No image is reviewed a second time."}
            </li>
            <li>
              {rules.ask_recall
                ? "Whoever finishes an image says how complete its labels are."
                : "Nobody is asked how complete the labels of an image are."}
            </li>
          </ul>
        </>
      )}
    </section>
  );
}

interface FormProps {
  slug: string;
  guidelines: Guidelines;
  close: () => void;
}

function GuidelinesForm({ slug, guidelines, close }: FormProps) {
  const client = useQueryClient();
  const [text, setText] = useState(guidelines.guidelines ?? "");
  const [share, setShare] = useState(Math.round(100 * guidelines.rules.second_share));
  const [asksRecall, setAsksRecall] = useState(guidelines.rules.ask_recall);
  const [saving, setSaving] = useState(false);

  async function submit(event: FormEvent): Promise<void> {
    event.preventDefault();
    setSaving(true);
    try {
      await changeGuidelines(slug, {
        guidelines: text.trim() === "" ? null : text,
        rules: { second_share: share / 100, ask_recall: asksRecall },
      });
      await Promise.all([
        client.invalidateQueries({ queryKey: keys.guidelines(slug) }),
        client.invalidateQueries({ queryKey: teamKeys.secondReviews(slug) }),
      ]);
      close();
    } catch (error) {
      toast({ key: "guidelines", tone: "danger", message: asProblem(error).message });
      setSaving(false);
    }
  }

  return (
    <form
      className="team__form"
      onSubmit={submit}
      onKeyDown={(event) => {
        if (event.key === "Escape") close();
      }}
    >
      <label className="field">
        <span className="field__label">Guidelines</span>
        <textarea
          className="input team__text"
          rows={10}
          value={text}
          maxLength={LONGEST}
          // biome-ignore lint/a11y/noAutofocus: it was opened to be written in
          autoFocus
          onChange={(event) => setText(event.target.value)}
        />
      </label>
      <label className="field field--row">
        <span className="field__label">Share reviewed a second time, %</span>
        <input
          className="input team__share"
          type="number"
          min={0}
          max={100}
          value={share}
          onChange={(event) => setShare(Math.min(100, Math.max(0, event.target.valueAsNumber || 0)))}
        />
      </label>
      <label className="check">
        <input
          type="checkbox"
          checked={asksRecall}
          onChange={(event) => setAsksRecall(event.target.checked)}
        />
        <span>Ask how complete the labels are when an image is done</span>
      </label>
      <div className="team__buttons">
        <Button onClick={close}>Cancel</Button>
        <Button tone="primary" type="submit" disabled={saving}>
          {saving ? "Saving…" : "Save"}
        </Button>
      </div>
    </form>
  );
}
