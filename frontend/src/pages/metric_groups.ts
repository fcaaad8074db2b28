/** All metrics, in the order of the pages. */

import { CLEARLINES_METRICS } from "./clearlines_metrics";
import type { MetricGroup } from "./metric";
import { PUBLISHED_METRICS } from "./published_metrics";

export const METRIC_GROUPS: readonly MetricGroup[] = [...CLEARLINES_METRICS, ...PUBLISHED_METRICS];
