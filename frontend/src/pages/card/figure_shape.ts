/** Width by height at which wide images stand below each other, as the server draws them. */
const WIDE = 2;
const PANELS = 3;
const USUAL = 4 / 3;

/** Width by height that the figure is going to have, from the size of an image: "1280 x 720". */
export function figureShape(size: string | undefined): number {
  const [width = 0, height = 0] = size?.split("x").map(Number) ?? [];
  const panel = width > 0 && height > 0 ? width / height : USUAL;
  return panel > WIDE ? panel / PANELS : panel * PANELS;
}
