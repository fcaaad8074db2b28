import { lineStyle, type StyleName } from "../../../canvas/style";
import { usePalette } from "../../../design/palette";
import { LineMark } from "../../../image_view/line_mark";

export function VerdictMark({ name }: { name: StyleName }) {
  return <LineMark style={lineStyle(name, usePalette())} />;
}
