import type { ReactNode } from "react";
import { Button } from "./button";
import { FormProblem } from "./form_problem";
import { useSentForm } from "./use_sent_form";
import "./sign_in.css";

interface EntranceFormProps {
  submitLabel: string;
  ready: boolean;
  /** Rejects with the reason, which is shown below the fields. */
  submit: () => Promise<void>;
  children: ReactNode;
}

/** Fields and one button; what the server says against them stands between. */
export function EntranceForm({ submitLabel, ready, submit, children }: EntranceFormProps) {
  const { onSubmit, busy, problem } = useSentForm(submit);
  return (
    <form className="entrance-form" onSubmit={onSubmit}>
      {children}
      <FormProblem text={problem} />
      <Button type="submit" tone="primary" busy={busy} disabled={!ready}>
        {submitLabel}
      </Button>
    </form>
  );
}
