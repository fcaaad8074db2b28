import { useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { changeCard } from "../../api/board_endpoints";
import { boardKeys } from "../../api/board_queries";
import type { Card } from "../../api/board_types";
import { keys } from "../../api/queries";
import { given, SavedForm } from "../saved_form";

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
  const save = async () => {
    await changeCard(slug, {
      description: given(description),
      licence: given(licence),
      citation: given(citation),
    });
    await client.invalidateQueries({ queryKey: boardKeys.card(slug) });
    void client.invalidateQueries({ queryKey: keys.dataset(slug), exact: true });
  };
  return (
    <SavedForm className="card-form" save={save} close={close}>
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
    </SavedForm>
  );
}
