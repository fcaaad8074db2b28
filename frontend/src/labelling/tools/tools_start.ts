/** The page's one tool box: what is in hand stays in hand from image to image. */

import { Preview } from "./preview";
import { ToolBox } from "./tool_box";

export const toolBox = new ToolBox();
export const preview = new Preview();
