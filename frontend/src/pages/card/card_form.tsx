import { useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { changeCard } from "../../api/board_endpoints";
import { boardKeys } from "../../api/board_queries";
import type { Card } from "../../api/board_types";
import { asProblem } from "../../api/problem";
import { keys } from "../../api/queries";
import { Button } from "../../design/button";
import { sentence } from "../../design/format";

interface CardFormProps {
  slug: string;
  card: Card;
  close: () => void;
}

/** What its maintainers say of a dataset. */
export function CardForm({ slug, card, close }: CardFormProps) {
  const client = useQueryClient();
  const [description, setDescription] = useState(card.description ?? "");
  const [licence, setLicence] = useState(card.licence ?? "");
  const [citation, setCitation] = useState(card.citation ?? "");
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<string | null>(null);
  const submit = async (event: FormEvent) => {
    event.preventDefault();
    setBusy(true);
    try {
      await changeCard(slug, {
        description: given(description),
        licence: given(licence),
        citation: given(citation),
      });
      await client.invalidateQueries({ queryKey: boardKeys.card(slug) });
      void client.invalidateQueries({ queryKey: keys.dataset(slug), exact: true });
      close();
    } catch (error) {
      setProblem(sentence(asProblem(error).message));
      setBusy(false);
    }
  };
  return (
    <form
      className="section card card-form"
      onSubmit={submit}
      onKeyDown={(event) => {
        if (event.key === "Escape") close();
      }}
    >
      <label className="field">
        <span className="field__label">Description</span>
        <textarea
          className="input card-form__text"
          // biome-ignore lint/a11y/noAutofocus: the form was opened to type into it
          autoFocus
          rows={3}
          maxLength={10_000}
          value={description}
          onChange={(event) => setDescription(event.target.value)}
        />
      </label>
      <label className="field">
        <span className="field__label">Licence</span>
        <input
          className="input"
          maxLength={200}
          placeholder="CC BY 4.0"
          value={licence}
          onChange={(event) => setLicence(event.target.value)}
        />
      </label>
      <label className="field">
        <span className="field__label">Citation, as BibTeX or text</span>
        <textarea
          className="input mono card-form__text"
          rows={5}
          maxLength={10_000}
          value={citation}
          onChange={(event) => setCitation(event.target.value)}
        />
      </label>
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
      <div className="board-page__actions">
        <Button type="submit" tone="primary" busy={busy}>
          Save
        </Button>
        <Button tone="quiet" onClick={close}>
          Cancel
        </Button>
      </div>
    </form>
  );
}

function given(text: string): string | null {
  const trimmed = text.trim();
  return trimmed === "" ? null : trimmed;
}
