/** What is wrong with a form, below its fields; nothing where nothing is. */
export function FormProblem({ text }: { text: string | null }) {
  return text === null ? null : (
    <p className="field__error" role="alert">
      {text}
    </p>
  );
}
