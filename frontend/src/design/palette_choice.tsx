import { PALETTES, type Palette } from "../canvas/palette";
import { setPalette, usePalette } from "./palette";
import { Segmented } from "./segmented";

const NAMES: Readonly<Record<Palette, { label: string; title: string }>> = {
  standard: { label: "Standard", title: "Green, orange, yellow and blue; told apart by form too" },
  safe: { label: "Colour-blind", title: "Blue, red, yellow and grey, which stay apart for every eye" },
};

/** The colours of verdicts, on all pages. */
export function PaletteChoice() {
  const palette = usePalette();
  return (
    <div className="panel-heading">
      <span className="field__label" aria-hidden="true">
        Colours
      </span>
      <Segmented
        label="Colours of verdicts"
        name="verdict-palette"
        value={palette}
        choices={PALETTES.map((value) => ({ value, ...NAMES[value] }))}
        onChange={setPalette}
      />
    </div>
  );
}
