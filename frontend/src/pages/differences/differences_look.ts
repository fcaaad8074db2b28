/** How an image's candidates look where differences are decided: the others are there, but faint. */

import type { Difference } from "../../api/team_endpoints";
import type { LineLook } from "../../canvas/layers/line_layer";
import type { Scene } from "../../canvas/scene";
import { lineStyle } from "../../canvas/style";

const OTHERS = { ...lineStyle("undecided"), opacity: 0.22, width: 1 };
const OPEN = lineStyle("undecided");
const DECIDED = {
  keep: lineStyle("keep"),
  reject: lineStyle("reject"),
  ambiguous: lineStyle("ambiguous"),
} as const;

export function differencesLook(scene: Scene, differences: readonly Difference[]): LineLook {
  const bySegment = new Map(differences.map((difference) => [difference.segment_id, difference]));
  return {
    styles: [OTHERS, DECIDED.reject, OPEN, DECIDED.ambiguous, DECIDED.keep],
    style: (index) => {
      const difference = bySegment.get(scene.polylines.ids[index] ?? -1);
      if (difference === undefined) return OTHERS;
      return difference.adjudicated === null ? OPEN : DECIDED[difference.adjudicated.verdict];
    },
    visible: () => true,
  };
}
