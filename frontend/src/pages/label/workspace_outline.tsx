import { useLayoutEffect, useRef } from "react";
import { linePainter } from "../../canvas/line_painter_start";
import { watchSize } from "../../canvas/watch_size";
import { LoadingState } from "../../design/states";
import "./tools/tool_bar.css";

/**
 * The page's places while the image is on its way. How large pictures will be is known by then, so that the lines can
 * be drawn as soon as they arrive, beside the making of the page.
 */
export function WorkspaceOutline() {
  const region = useRef<HTMLElement>(null);

  useLayoutEffect(() => {
    const host = region.current;
    if (host === null) return;
    return watchSize(host, (size, ratio) => linePainter.setScreen(size, ratio));
  }, []);

  return (
    <div className="image-page">
      <div className="image-stage">
        <section ref={region} className="image-canvas label-canvas">
          <LoadingState label="Loading the image" />
        </section>
        <div className="tool-bar" />
        <div className="status-strip" />
      </div>
      <aside className="image-panel" />
    </div>
  );
}
