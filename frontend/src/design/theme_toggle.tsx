import { IconButton } from "./button";
import { type ThemeChoice, useTheme } from "./theme";

const NEXT: Record<ThemeChoice, ThemeChoice> = { auto: "light", light: "dark", dark: "auto" };
const ICON = { auto: "auto", light: "sun", dark: "moon" } as const;
const NAME = { auto: "as the system", light: "light", dark: "dark" } as const;

export function ThemeToggle() {
  const { choice, setChoice } = useTheme();
  return (
    <IconButton
      icon={ICON[choice]}
      label={`Theme: ${NAME[choice]}`}
      side="end"
      onClick={() => setChoice(NEXT[choice])}
    />
  );
}
