import { useState } from "react";
import type { Method } from "../../api/board_types";
import { given, SavedForm } from "../saved_form";
import { UrlField } from "../url_field";
import { useMethodActions } from "./use_method_actions";

/** What its owner says of a method. */
export function MethodForm({ method, close }: { method: Method; close: () => void }) {
  const { change } = useMethodActions(method);
  const [name, setName] = useState(method.name);
  const [description, setDescription] = useState(method.description ?? "");
  const [code, setCode] = useState(method.code_url ?? "");
  const [paper, setPaper] = useState(method.paper_url ?? "");
  const save = () =>
    change({
      name: name.trim(),
      description: given(description),
      code_url: given(code),
      paper_url: given(paper),
    });
  return (
    <SavedForm className="method-form" save={save} close={close}>
      <label className="field">
        <span className="field__label">Name</span>
        <input
          className="input"
          // biome-ignore lint/a11y/noAutofocus: the form was opened to type into it
          autoFocus
          required
          maxLength={200}
          value={name}
          onChange={(event) => setName(event.target.value)}
        />
      </label>
      <label className="field">
        <span className="field__label">Description</span>
        <textarea
          className="input method-form__text"
          rows={4}
          maxLength={4000}
          value={description}
          onChange={(event) => setDescription(event.target.value)}
        />
      </label>
      <div className="method-form__links">
        <UrlField label="Code" value={code} onChange={setCode} />
        <UrlField label="Paper" value={paper} onChange={setPaper} />
      </div>
    </SavedForm>
  );
}
