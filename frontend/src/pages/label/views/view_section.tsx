import { Button } from "../../../design/button";
import { Keys } from "../../../design/kbd";
import { PaletteChoice } from "../../../design/palette_choice";
import { Segmented } from "../../../design/segmented";
import {
  type ImageLook,
  type ImageView,
  isPlain,
  MOST_STEPS,
  PLAIN_LOOK,
} from "../../../labelling/views/image_look";
import "./views.css";

const NAMES: Readonly<Record<ImageView, { label: string; title: string }>> = {
  plain: { label: "Plain", title: "The pixels as they are stored" },
  clahe: { label: "CLAHE", title: "Contrast evened out tile by tile: shows edges in shadows (B)" },
  undistorted: {
    label: "Straight",
    title: "Without the lens's distortion: straight lines look straight (V)",
  },
};

interface ViewSectionProps {
  look: ImageLook;
  onChange: (look: ImageLook) => void;
}

/** How the image is shown. */
export function ViewSection({ look, onChange }: ViewSectionProps) {
  return (
    <section className="panel-section" aria-label="View">
      <div className="panel-heading">
        <h2>View</h2>
        <span className="panel-heading__end">
          {isPlain(look) ? null : (
            <Button small tone="quiet" aria-keyshortcuts="Shift+B" onClick={() => onChange(PLAIN_LOOK)}>
              Reset <Keys keys={["Shift", "B"]} />
            </Button>
          )}
        </span>
      </div>
      <Segmented
        label="View of the image"
        name="image-view"
        value={look.view}
        choices={Object.entries(NAMES).map(([value, { label, title }]) => ({
          value: value as ImageView,
          label,
          title,
        }))}
        onChange={(view) => onChange({ ...look, view })}
      />
      <Slider
        label="Brightness"
        value={look.brightness}
        onChange={(brightness) => onChange({ ...look, brightness })}
      />
      <Slider
        label="Contrast"
        value={look.contrast}
        onChange={(contrast) => onChange({ ...look, contrast })}
      />
      <PaletteChoice />
    </section>
  );
}

interface SliderProps {
  label: string;
  value: number;
  onChange: (value: number) => void;
}

function Slider({ label, value, onChange }: SliderProps) {
  return (
    <label className="look-slider">
      <span className="look-slider__label">{label}</span>
      <input
        type="range"
        min={-MOST_STEPS}
        max={MOST_STEPS}
        step={1}
        value={value}
        onChange={(event) => onChange(event.currentTarget.valueAsNumber)}
      />
      <span className="look-slider__value numeric">
        {value > 0 ? `+${value}` : value < 0 ? `−${-value}` : "0"}
      </span>
    </label>
  );
}
