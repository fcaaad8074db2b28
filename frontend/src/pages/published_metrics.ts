/** The metrics of the paper: as its own script has them, and counted one-to-one. */

import { type MetricGroup, metric } from "./metric";

export const PUBLISHED_METRICS: readonly MetricGroup[] = [
  {
    title: "As published",
    protocol: "official-v1",
    note: "The paper's own script: box overlap, not one-to-one. For comparison with published numbers, never the rank.",
    metrics: [
      metric(
        "official_f1",
        "F1",
        "v1 F1",
        "ratio",
        "higher",
        "Of the averages of P and R; passes 1 with copies of a line.",
      ),
      metric(
        "official_precision",
        "Precision",
        "v1 P",
        "share",
        "higher",
        "Predictions whose box overlaps some label's by half.",
      ),
      metric(
        "official_recall",
        "Recall",
        "v1 R",
        "ratio",
        "higher",
        "The same number by the labels; passes 1 with copies of a line.",
      ),
    ],
  },
  {
    title: "As published, one-to-one",
    protocol: "official-v1-fixed",
    note: "The same box overlap, each label counted once.",
    metrics: [
      metric("fixed_f1", "F1", "fixed F1", "share", "higher", "Over all images together."),
      metric("fixed_precision", "Precision", "fixed P", "share", "higher", "Over all images together."),
      metric("fixed_recall", "Recall", "fixed R", "share", "higher", "Over all images together."),
      metric("fixed_macro_f1", "F1, macro", "macro F1", "share", "higher", "Of the averages over images."),
      metric(
        "fixed_macro_precision",
        "Precision, macro",
        "macro P",
        "share",
        "higher",
        "Averaged over images.",
      ),
      metric("fixed_macro_recall", "Recall, macro", "macro R", "share", "higher", "Averaged over images."),
    ],
  },
];
