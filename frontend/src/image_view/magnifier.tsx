import { useEffect, useRef } from "react";
import { clearSurface, makeSurface, resizeSurface } from "../canvas/layers/surface";
import { drawMagnifier, MAGNIFICATION } from "../canvas/magnifier";
import type { Scene } from "../canvas/scene";
import { afterNextFrame } from "./after_next_frame";

interface MagnifierProps {
  scene: Scene;
  bitmap: ImageBitmap | null;
  index: number;
  colour: string;
}

/** Start, middle and end of a line, enlarged, to see whether it lies on its edge. */
export function Magnifier({ scene, bitmap, index, colour }: MagnifierProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const element = canvas.current;
    if (element === null || bitmap === null) return;
    return afterNextFrame(() => {
      const surface = makeSurface(element);
      const size = { width: element.clientWidth, height: element.clientHeight };
      const ratio = window.devicePixelRatio || 1;
      resizeSurface(surface, size, ratio);
      clearSurface(surface);
      drawMagnifier(surface, size, ratio, bitmap, bitmap, scene, index, colour);
    });
  }, [scene, bitmap, index, colour]);
  return (
    <figure className="magnifier">
      <canvas ref={canvas} />
      <figcaption>
        <span>start</span>
        <span>middle</span>
        <span>end, {MAGNIFICATION}×</span>
      </figcaption>
    </figure>
  );
}
