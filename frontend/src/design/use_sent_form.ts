import { type FormEvent, useState } from "react";
import { problemText } from "../api/problem";

/**
 * What a form needs that is sent as a whole.
 *
 * @param send Rejects with the reason, which is kept as `problem` until it is sent again.
 */
export function useSentForm(send: () => Promise<unknown>) {
  const [problem, setProblem] = useState<string | null>(null);
  const [busy, setBusy] = useState(false);
  const onSubmit = async (event: FormEvent) => {
    event.preventDefault();
    setBusy(true);
    setProblem(null);
    try {
      await send();
    } catch (error) {
      setProblem(problemText(error));
    }
    setBusy(false);
  };
  return { onSubmit, busy, problem };
}
