/** What keys do on pages that show one image: one object per command, the same keys for the same things. */

export interface Command<Actions> {
  readonly id: string;
  /** Alternatives; each is one key with its modifiers, as in "Shift+Tab". */
  readonly keys: readonly string[];
  readonly label: string;
  /** Heading in the list of keys. */
  readonly group: string;
  /** The key has a meaning of its own on buttons and links, so it acts on the image alone. */
  readonly onImageOnly?: boolean;
  /** Holding the key repeats the command. */
  readonly repeats?: boolean;
  readonly run: (actions: Actions) => void;
}

/** What the view of an image can do. */
export interface ViewActions {
  fit(): void;
  zoom(direction: 1 | -1): void;
  pan(dx: number, dy: number): void;
}

/** What any page of one image can do. */
export interface ImagePageActions {
  goToImage(direction: 1 | -1): void;
  toggleKeyList(): void;
}

/** Share of the screen that an arrow key moves the view by. */
const PAN_STEP = 0.15;

export const VIEW_COMMANDS: readonly Command<ViewActions>[] = [
  { id: "fit", keys: ["F"], label: "Fit the image", group: "View", run: (a) => a.fit() },
  { id: "zoom-in", keys: ["+", "="], label: "Zoom in", group: "View", repeats: true, run: (a) => a.zoom(1) },
  { id: "zoom-out", keys: ["-"], label: "Zoom out", group: "View", repeats: true, run: (a) => a.zoom(-1) },
  ...(
    [
      ["ArrowLeft", "left", PAN_STEP, 0],
      ["ArrowRight", "right", -PAN_STEP, 0],
      ["ArrowUp", "up", 0, PAN_STEP],
      ["ArrowDown", "down", 0, -PAN_STEP],
    ] as const
  ).map(
    ([key, side, dx, dy]): Command<ViewActions> => ({
      id: `pan-${side}`,
      keys: [key],
      label: `Move ${side}`,
      group: "View",
      onImageOnly: true,
      repeats: true,
      run: (a) => a.pan(dx, dy),
    }),
  ),
];

export const TOGGLE_KEY_LIST: Command<Pick<ImagePageActions, "toggleKeyList">> = {
  id: "key-list",
  keys: ["?"],
  label: "Show or hide this list",
  group: "Image",
  run: (a) => a.toggleKeyList(),
};

export const IMAGE_PAGE_COMMANDS: readonly Command<ImagePageActions>[] = [
  { id: "next-image", keys: ["N", "]"], label: "Next image", group: "Image", run: (a) => a.goToImage(1) },
  {
    id: "previous-image",
    keys: ["P", "["],
    label: "Previous image",
    group: "Image",
    run: (a) => a.goToImage(-1),
  },
  TOGGLE_KEY_LIST,
];

/** The same keys on a page where they are called otherwise; by the commands' ids. */
export function reworded<Actions>(
  commands: readonly Command<Actions>[],
  words: Readonly<Record<string, string>>,
): Command<Actions>[] {
  return commands.map((command) => ({ ...command, label: words[command.id] ?? command.label }));
}

const KEY_CAPS: Readonly<Record<string, string>> = {
  Escape: "Esc",
  ArrowLeft: "←",
  ArrowRight: "→",
  ArrowUp: "↑",
  ArrowDown: "↓",
  "-": "−",
};

/** The key caps of one alternative: "Shift+Tab" gives Shift and Tab. */
export function keyCaps(key: string): string[] {
  if (key === "+") return ["+"];
  return key.split("+").map((part) => KEY_CAPS[part] ?? part);
}
