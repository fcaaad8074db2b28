/** The page's one worker for pictures of lines, and what draws by it. */

import { LinePainter } from "./line_painter";
import { PictureDesk } from "./picture_desk";
import { drawPicture } from "./picture_task";

const desk = new PictureDesk(
  () => new Worker(new URL("./picture_worker.ts", import.meta.url), { type: "module" }),
  drawPicture,
);

export const linePainter = new LinePainter((drawing) => desk.draw(drawing));
