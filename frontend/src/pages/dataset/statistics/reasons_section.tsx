import type { Statistics } from "../../../api/team_endpoints";
import { formatCount } from "../../../design/format";
import { REASON_NAMES } from "../../../labelling/reasons";

/** Why candidates were rejected, where that was said. */
export function ReasonsSection({ reasons }: { reasons: Statistics["reasons"] }) {
  const most = Math.max(1, ...reasons.map(({ count }) => count));
  const given = reasons.filter(({ count }) => count > 0);
  return (
    <section className="section card" aria-labelledby="reasons-title">
      <h2 id="reasons-title">Reasons for rejections</h2>
      {given.length === 0 ? (
        <p className="muted">None given yet: the keys 1 to 5 reject with a reason.</p>
      ) : (
        <ul className="reasons">
          {given.map(({ reason, count }) => (
            <li key={reason}>
              <span>{REASON_NAMES[reason]}</span>
              <span className="reasons__bar" aria-hidden="true">
                <span style={{ width: `${(100 * count) / most}%` }} />
              </span>
              <span className="numeric muted">{formatCount(count)}</span>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}
