import { Icon } from "../../../design/icons";

export const LOOKING_ONLY = "Judging needs the role annotator. Sign in at the top with a token that has it.";

/** Why nothing can be judged on this page. */
export function LookingOnly({ why }: { why: string }) {
  return (
    <p className="looking-only">
      <Icon name="lock" size={14} /> {why}
    </p>
  );
}
