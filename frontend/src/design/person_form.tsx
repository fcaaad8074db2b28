import { useQueryClient } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { boardKeys } from "../api/board_queries";
import { choosePerson, chosenPerson, LONGEST_NAME } from "../api/person";
import { Button } from "./button";

/** Asks for the name under which decisions are stored, where no token says it. */
export function PersonForm({ close }: { close: () => void }) {
  const client = useQueryClient();
  const [name, setName] = useState(() => chosenPerson() ?? "");
  const submit = async (event: FormEvent) => {
    event.preventDefault();
    choosePerson(name);
    // Whose task an image is and who holds it is answered for this name from now on.
    await client.invalidateQueries({ queryKey: boardKeys.me });
    close();
  };
  return (
    <form className="sign-in__form" onSubmit={submit}>
      <label className="field">
        <span className="field__label">Your name</span>
        <input
          className="input"
          autoComplete="name"
          spellCheck={false}
          maxLength={LONGEST_NAME}
          placeholder="As others know you"
          value={name}
          onChange={(event) => setName(event.target.value)}
        />
        <span className="field__hint">Others see who decided, and who is at an image.</span>
      </label>
      <Button type="submit" tone="primary" disabled={name.trim() === (chosenPerson() ?? "")}>
        {name.trim() === "" ? "Give the name up" : "Use this name"}
      </Button>
    </form>
  );
}
