import { useState } from "react";
import { Button } from "../../design/button";
import { Icon } from "../../design/icons";
import { figureShape } from "./figure_shape";

const WHAT = "One image of the dataset: bare first, then with its lines; what was kept comes last.";

interface FigureProps {
  address: string;
  /** "1280 x 720": the usual size of the images. */
  size: string | undefined;
}

/** The picture of the dataset. The server draws it when it is asked for, which takes a moment. */
export function Figure({ address, size }: FigureProps) {
  const [state, setState] = useState<"loading" | "shown" | "failed">("loading");
  const [attempt, setAttempt] = useState(0);
  return (
    <figure className="section card card-figure" data-state={state}>
      {state === "failed" ? (
        <div className="card-figure__place" role="alert">
          <Icon name="image" size={24} />
          <span>The figure can't be shown.</span>
          <Button
            small
            icon="retry"
            onClick={() => {
              setState("loading");
              setAttempt(attempt + 1);
            }}
          >
            Try again
          </Button>
        </div>
      ) : (
        <div className="card-figure__frame">
          {state === "loading" ? (
            <div
              className="card-figure__place card-figure__place--loading"
              role="status"
              style={{ aspectRatio: figureShape(size) }}
            >
              <span className="spinner" aria-hidden="true" />
              <span>Drawing the figure</span>
            </div>
          ) : null}
          <img
            key={attempt}
            src={address}
            alt={WHAT}
            onLoad={() => setState("shown")}
            onError={() => setState("failed")}
          />
        </div>
      )}
      <figcaption className="muted">{WHAT}</figcaption>
    </figure>
  );
}
