import { useRef } from "react";
import type { Evidence } from "../../../api/types";
import { useWidth } from "../../../charts/use_width";
import { layOutStrip } from "../../../labelling/evidence/strip";
import { useEvidence } from "./use_evidence";
import "./evidence.css";

const HEIGHT = 56;
const NARROW = 240;

/** What speaks for and against the selected candidate, measured along it. */
export function EvidenceSection({ imageId, segmentId }: { imageId: number; segmentId: number }) {
  const { evidence, error } = useEvidence(imageId, segmentId);
  if (error) return <p className="muted panel-hint">The evidence couldn't be measured.</p>;
  return (
    <figure className="evidence" aria-busy={evidence === null}>
      <DeviationStrip evidence={evidence} />
      <figcaption>
        {evidence === null ? <span className="muted">Measuring…</span> : <Words {...evidence} />}
      </figcaption>
    </figure>
  );
}

/** Deviation from straight, enlarged; the band is where a line counts as straight. */
function DeviationStrip({ evidence }: { evidence: Evidence | null }) {
  const frame = useRef<HTMLDivElement>(null);
  const width = useWidth(frame, NARROW);
  const strip = evidence === null ? null : layOutStrip(evidence.along, evidence.deviation, width, HEIGHT);
  return (
    <div ref={frame} className="evidence__strip">
      {strip === null || evidence === null ? null : (
        <>
          <svg
            width={width}
            height={HEIGHT}
            role="img"
            aria-label={`Deviation from straight: ${evidence.residual.toFixed(2)} px RMS, ${evidence.maximum.toFixed(2)} px at most`}
          >
            <rect
              className="evidence__band"
              x="0"
              y={(HEIGHT - Math.min(strip.band, HEIGHT)) / 2}
              width={width}
              height={Math.min(strip.band, HEIGHT)}
            />
            <line className="evidence__axis" x1="0" x2={width} y1={HEIGHT / 2} y2={HEIGHT / 2} />
            <path className="evidence__line" d={strip.path} />
          </svg>
          <span className="evidence__scale numeric" title="How far the strip reaches to either side">
            ±{strip.reach} px
          </span>
        </>
      )}
    </div>
  );
}

const STRAIGHT_UNDER: Readonly<Record<Evidence["lens"], string>> = {
  accepted: "from straight under the camera's lens",
  refused: "from straight as it is: the lens isn't known yet",
  none: "from straight as it is: the lens isn't known yet",
};

function Words({ residual, maximum, contrast, evenness, polarity, lens }: Evidence) {
  return (
    <>
      <span className="muted">
        <b className="numeric">{residual.toFixed(2)} px</b> RMS,{" "}
        <b className="numeric">{maximum.toFixed(2)}</b> at most, {STRAIGHT_UNDER[lens]}
      </span>
      <dl className="facts">
        <Fact
          name="Contrast"
          value={`${Math.round(contrast)} levels`}
          hint="Median step of brightness across the edge"
        />
        <Fact
          name="Evenness"
          value={evenness.toFixed(2)}
          hint="Weak quarter of the edge against its median: 1 is alike all along, 0 has gaps"
        />
        <Fact
          name="One side"
          value={`${Math.round(100 * polarity)} %`}
          hint="Share of the edge whose bright side is the usual one"
        />
      </dl>
    </>
  );
}

function Fact({ name, value, hint }: { name: string; value: string; hint: string }) {
  return (
    <div title={hint}>
      <dt>{name}</dt>
      <dd className="numeric">{value}</dd>
    </div>
  );
}
