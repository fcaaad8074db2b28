import { describe, expect, it } from "vitest";
import { LinePainter } from "./line_painter";
import type { Drawing } from "./picture_task";
import { makeScene } from "./scene";
import type { LineStyle } from "./style";
import { fitted } from "./viewport";

const IMAGE = { width: 200, height: 100 };
const SCREEN = { width: 400, height: 300 };
const keep: LineStyle = { colour: "#00ff00", width: 2, dash: [], opacity: 1 };
const reject: LineStyle = { colour: "#ff0000", width: 1, dash: [], opacity: 1 };
const look = { styles: [reject, keep], style: () => keep, visible: () => true };

const oneLine = () =>
  makeScene({
    revision: 1,
    ids: Uint32Array.of(1),
    offsets: Uint32Array.of(0, 2),
    coordinates: Float32Array.of(10, 10, 190, 90),
  });

/** A painter whose pictures are drawn at once, and are counted; they know whether they were closed. */
function paintedBy(screen = SCREEN) {
  const drawn: Drawing[] = [];
  const closed = new Set<ImageBitmap>();
  const painter = new LinePainter(async (drawing) => {
    drawn.push(drawing);
    const picture = { close: () => closed.add(picture as ImageBitmap) } as unknown as ImageBitmap;
    return picture;
  });
  painter.setScreen(screen, 1);
  const open = (scene: ReturnType<typeof oneLine>, of = look) =>
    painter.paint(scene, painter.drawingOf(scene, of, fitted(IMAGE, screen), screen, 1));
  return { painter, drawn, closed, open };
}

const settled = () => new Promise((resolve) => setTimeout(resolve));

describe("a picture prepared", () => {
  it("is there at once when its image is opened, and is given away", async () => {
    const { painter, drawn, open } = paintedBy();
    const scene = oneLine();
    painter.prepare(scene, look, IMAGE);
    await settled();
    expect(open(scene)).not.toBeInstanceOf(Promise);
    expect(drawn).toHaveLength(1);
    expect(open(scene)).toBeInstanceOf(Promise);
    expect(drawn).toHaveLength(2);
  });

  it("is waited for, not drawn again, when its image is opened before", async () => {
    const { painter, drawn, open } = paintedBy();
    const scene = oneLine();
    painter.prepare(scene, look, IMAGE);
    await open(scene);
    expect(drawn).toHaveLength(1);
  });

  it("is thrown away when lines look different by then", async () => {
    const { painter, drawn, closed, open } = paintedBy();
    const scene = oneLine();
    painter.prepare(scene, look, IMAGE);
    await settled();
    await open(scene, { ...look, style: () => reject });
    expect(drawn).toHaveLength(2);
    await settled();
    expect(closed.size).toBe(1);
  });

  it("isn't drawn twice for the same look", async () => {
    const { painter, drawn } = paintedBy();
    const scene = oneLine();
    painter.prepare(scene, look, IMAGE);
    painter.prepare(scene, { ...look }, IMAGE);
    expect(drawn).toHaveLength(1);
  });

  it("gives its memory back when there are too many", async () => {
    const { painter, closed } = paintedBy({ width: 2000, height: 1500 });
    const scenes = [oneLine(), oneLine(), oneLine(), oneLine()];
    for (const scene of scenes) painter.prepare(scene, look, IMAGE);
    await settled();
    expect(closed.size).toBe(2);
  });
});
