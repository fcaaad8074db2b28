import type { StageHistory } from "../../../api/types";
import { type ScoreBar, scoreBars, signed, typicalScore } from "../../../labelling/stage_text";

const MEANINGS: Readonly<Record<string, string>> = {
  Length: "From end to end",
  Closeness: "Share of its way with an edge point within half a pixel, in its direction",
  "Edge strength": "Mean gradient along it, grey levels",
  Roughness: "How far its points scatter about the arc, RMS",
  "Longest gap": "Longest part of its way without an edge point",
  Contrast: "Difference of the grey levels on both sides",
};

/** What the score is made of: each feature as measured, and how it differs from what is typical in the image. */
export function ScoreTable({ history }: { history: StageHistory }) {
  return (
    <section aria-label="Score">
      <div className="stages__heading">
        <h3>
          Score <span className="numeric">{history.score.toFixed(2)}</span>
        </h3>
        <span className="muted numeric">{typicalScore(history).toFixed(2)} is typical here</span>
      </div>
      <table className="score-table">
        <thead className="visually-hidden">
          <tr>
            <th scope="col">Feature</th>
            <th scope="col">Measured</th>
            <th scope="col">Raises or lowers the score</th>
          </tr>
        </thead>
        <tbody>
          {scoreBars(history.score_parts).map((bar) => (
            <ScoreRow key={bar.name} bar={bar} />
          ))}
        </tbody>
      </table>
      <p className="score-table__scale muted" aria-hidden="true">
        <span>lowers</span>
        <span>raises</span>
      </p>
    </section>
  );
}

function ScoreRow({ bar }: { bar: ScoreBar }) {
  const { name, measured, effect, share } = bar;
  return (
    <tr title={MEANINGS[name]}>
      <th scope="row">{name}</th>
      <td className="numeric">{measured}</td>
      <td>
        <span className="score-bar" aria-hidden="true">
          <span
            className={share < 0 ? "score-bar__fill score-bar__fill--lowers" : "score-bar__fill"}
            style={{ width: `${50 * Math.abs(share)}%` }}
          />
        </span>
        <span className="visually-hidden">{signed(effect)}</span>
      </td>
    </tr>
  );
}
