import { MATCH_STYLES, PALETTES, type Palette } from "../../canvas/match_style";
import { formatCount } from "../../design/format";
import { Icon } from "../../design/icons";
import { Keys } from "../../design/kbd";
import { Segmented } from "../../design/segmented";
import { LineMark } from "../../image_view/line_mark";
import { LAYER_NAMES, LAYERS, type Layer, type ShownLayers } from "./layers";
import type { MatchedImage } from "./matched_image";
import { layerKey } from "./viewer_commands";

const PALETTE_NAMES: Readonly<Record<Palette, { label: string; title: string }>> = {
  paper: { label: "Paper", title: "Green, red and orange as in the ClearLines paper" },
  safe: { label: "Colour-blind", title: "Blue, vermilion and yellow after Okabe and Ito" },
};

interface LayersSectionProps {
  /** As scored for each submission that is shown. */
  images: readonly MatchedImage[];
  shown: ShownLayers;
  bare: boolean;
  palette: Palette;
  onLayer: (layer: Layer) => void;
  onPalette: (palette: Palette) => void;
}

/** The legend: what each kind of line looks like, how many there are, and whether they are shown. */
export function LayersSection({ images, shown, bare, palette, onLayer, onPalette }: LayersSectionProps) {
  return (
    <section className="panel-section" aria-label="Layers">
      <ul className="shown-list">
        {LAYERS.map((layer) => (
          <LayerRow
            key={layer}
            layer={layer}
            counts={images.map(({ counts }) => counts[layer])}
            shown={shown[layer] && !bare}
            palette={palette}
            onToggle={() => onLayer(layer)}
          />
        ))}
      </ul>
      <div className="panel-heading">
        <span className="field__label" aria-hidden="true">
          Colours
        </span>
        <Segmented
          label="Colours"
          name="palette"
          value={palette}
          choices={PALETTES.map((value) => ({ value, ...PALETTE_NAMES[value] }))}
          onChange={onPalette}
        />
      </div>
    </section>
  );
}

interface LayerRowProps {
  layer: Layer;
  counts: readonly number[];
  shown: boolean;
  palette: Palette;
  onToggle: () => void;
}

function LayerRow({ layer, counts, shown, palette, onToggle }: LayerRowProps) {
  const { many, hint } = LAYER_NAMES[layer];
  return (
    <li className={`shown-row layer-row${shown ? "" : " shown-row--hidden"}`} title={hint}>
      <LineMark style={MATCH_STYLES[palette].plain[layer]} />
      <span>{many}</span>
      <span className="shown-row__count numeric">{counts.map(formatCount).join(" / ")}</span>
      <Keys keys={[layerKey(layer)]} />
      <button
        type="button"
        className="button button--quiet button--small button--icon"
        aria-label={`Show ${many.toLowerCase()}`}
        aria-pressed={shown}
        aria-keyshortcuts={layerKey(layer)}
        onClick={onToggle}
      >
        <Icon name={shown ? "eye" : "eyeOff"} />
      </button>
    </li>
  );
}
