/** How the image under the candidates is shown: what is stored never changes. */

export const IMAGE_VIEWS = ["plain", "clahe", "undistorted"] as const;
export type ImageView = (typeof IMAGE_VIEWS)[number];

export interface ImageLook {
  readonly view: ImageView;
  /** Steps of brightness and of contrast; 0 is the image as it is. */
  readonly brightness: number;
  readonly contrast: number;
}

export const PLAIN_LOOK: ImageLook = { view: "plain", brightness: 0, contrast: 0 };
/** Most steps to either side. */
export const MOST_STEPS = 6;
/** What one step multiplies by: six of them make a night street readable. */
const BRIGHTER = 1.3;
const HARDER = 1.2;

/** Shows a view, or the plain one where it is shown already. */
export function toggledView(look: ImageLook, view: ImageView): ImageLook {
  return { ...look, view: look.view === view ? "plain" : view };
}

export function stepped(look: ImageLook, part: "brightness" | "contrast", steps: number): ImageLook {
  const value = Math.min(MOST_STEPS, Math.max(-MOST_STEPS, look[part] + steps));
  return value === look[part] ? look : { ...look, [part]: value };
}

/** The CSS filter of the image's canvas; "none" costs nothing while the view moves. */
export function cssFilter({ brightness, contrast }: ImageLook): string {
  const parts: string[] = [];
  if (brightness !== 0) parts.push(`brightness(${(BRIGHTER ** brightness).toFixed(3)})`);
  if (contrast !== 0) parts.push(`contrast(${(HARDER ** contrast).toFixed(3)})`);
  return parts.length === 0 ? "none" : parts.join(" ");
}

export function isPlain(look: ImageLook): boolean {
  return look.view === "plain" && look.brightness === 0 && look.contrast === 0;
}

/** "Brightness +2": what a key has just done. */
export function describeStep(part: "brightness" | "contrast", { [part]: steps }: ImageLook): string {
  const name = part === "brightness" ? "Brightness" : "Contrast";
  if (steps === 0) return `${name} as stored`;
  return `${name} ${steps > 0 ? "+" : "−"}${Math.abs(steps)}`;
}
