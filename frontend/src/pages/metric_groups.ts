/** The metrics of the protocols: how they are called and what they say. */

export type MetricUnit = "share" | "px" | "degrees" | "ratio" | "count";

export interface Metric {
  key: string;
  /** As a row is called. */
  name: string;
  /** As a column is called. */
  short: string;
  unit: MetricUnit;
  /** "near 0" and "near 1" say which value is best where neither end is. */
  best: "higher" | "lower" | "near 0" | "near 1";
  meaning: string;
}

const metric = (
  key: string,
  name: string,
  short: string,
  unit: MetricUnit,
  best: Metric["best"],
  meaning: string,
): Metric => ({ key, name, short, unit, best, meaning });

export interface MetricGroup {
  title: string;
  /** Which protocol the numbers stand under. */
  protocol: string;
  note: string;
  metrics: readonly Metric[];
}

export const METRIC_GROUPS: readonly MetricGroup[] = [
  {
    title: "Detection",
    protocol: "clearlines-v2",
    note: "One prediction per label; tolerance 3 px, 15 degrees and half the length, at every orientation.",
    metrics: [
      metric(
        "f1",
        "F1",
        "F1",
        "share",
        "higher",
        "2TP / (2TP + FP + FN) over all images. The rank goes by it.",
      ),
      metric(
        "precision",
        "Precision",
        "P",
        "share",
        "higher",
        "Share of the predictions that found a label.",
      ),
      metric("recall", "Recall", "R", "share", "higher", "Share of the labels that were found."),
      metric(
        "mean_f1",
        "Mean F1",
        "Mean F1",
        "share",
        "higher",
        "F1 averaged over overlaps .50 to .95 and tolerances 1, 2, 3 and 5 px: rewards exact lines.",
      ),
      metric(
        "ap",
        "Average precision",
        "AP",
        "share",
        "higher",
        "Precision averaged over recall, best scores first; only where predictions carry scores.",
      ),
    ],
  },
  {
    title: "Length",
    protocol: "clearlines-v2",
    note: "By length in px instead of by count, so that long lines weigh more.",
    metrics: [
      metric(
        "completeness",
        "Completeness",
        "Compl.",
        "share",
        "higher",
        "Labelled length that is near a prediction.",
      ),
      metric(
        "correctness",
        "Correctness",
        "Corr.",
        "share",
        "higher",
        "Predicted length that is near a label.",
      ),
      metric("quality", "Quality", "Quality", "share", "higher", "Both in one: CK / (C + K - CK)."),
    ],
  },
  {
    title: "Structure",
    protocol: "clearlines-v2",
    note: "Whether one line in the image is one line in the result.",
    metrics: [
      metric(
        "fragmentation",
        "Fragmentation",
        "Frag.",
        "ratio",
        "near 1",
        "Predictions per label that was found.",
      ),
      metric(
        "merge",
        "Merge",
        "Merge",
        "share",
        "lower",
        "Share of the matches that cover two labels or more.",
      ),
      metric(
        "redundancy",
        "Redundancy",
        "Redund.",
        "share",
        "lower",
        "Matched length that is there more than once.",
      ),
    ],
  },
  {
    title: "Localisation",
    protocol: "clearlines-v2",
    note: "Of the true positives alone.",
    metrics: [
      metric(
        "offset_mean",
        "Offset, mean",
        "Offset",
        "px",
        "lower",
        "Distance from the prediction to the labelled curve.",
      ),
      metric(
        "offset_median",
        "Offset, median",
        "Median",
        "px",
        "lower",
        "Half of the points lie nearer than this.",
      ),
      metric(
        "offset_p95",
        "Offset, 95th percentile",
        "p95",
        "px",
        "lower",
        "All but every twentieth point lie nearer.",
      ),
      metric("bias", "Bias", "Bias", "px", "near 0", "Offset with its sign: to which side the lines lie."),
      metric(
        "angle_error",
        "Rotation error",
        "Angle",
        "degrees",
        "lower",
        "Angle between the tangents of the two.",
      ),
      metric(
        "translation_error",
        "Translation error",
        "Shift",
        "px",
        "lower",
        "Offset along the normal of the label.",
      ),
      metric(
        "mean_liou",
        "Line IoU",
        "LIoU",
        "share",
        "higher",
        "Shared length by the length of both together.",
      ),
    ],
  },
  {
    title: "Calibration",
    protocol: "clearlines-v2",
    note: "The lens that the submitted lines alone would give, tried on the labelled lines.",
    metrics: [
      metric(
        "calibration_rms",
        "Straightness after undistortion",
        "Calib.",
        "px",
        "lower",
        "RMS of the labelled lines from straight ones, under the estimated lens.",
      ),
      metric(
        "calibration_grid",
        "Difference to the reference lens",
        "Grid",
        "px",
        "lower",
        "RMS over the frame after the best homography; only where the true lens is known.",
      ),
    ],
  },
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
