"""The formula of official-v1 as a plain double loop: what speed is measured against, and an independent result."""

from __future__ import annotations

from collections.abc import Sequence

Box = tuple[float, float, float, float]
Points = Sequence[tuple[float, float]]


def padded_box(points: Points) -> Box:
    """Return the extremes of the points, sides below 10 px padded on both ends alike."""
    x0, x1 = min(x for x, _ in points), max(x for x, _ in points)
    y0, y1 = min(y for _, y in points), max(y for _, y in points)
    if x1 - x0 < 10:
        x0, x1 = x0 - (10 - (x1 - x0)) / 2, x1 + (10 - (x1 - x0)) / 2
    if y1 - y0 < 10:
        y0, y1 = y0 - (10 - (y1 - y0)) / 2, y1 + (10 - (y1 - y0)) / 2
    return x0, y0, x1, y1


def iou(a: Box, b: Box) -> float:
    """Return the intersection over union of two boxes."""
    common = max(0.0, min(a[2], b[2]) - max(a[0], b[0])) * max(0.0, min(a[3], b[3]) - max(a[1], b[1]))
    return common / ((a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - common)


def precision_and_recall(labels: Sequence[Points], predictions: Sequence[Points]) -> tuple[float, float]:
    """Score one image that has labels and predictions."""
    label_boxes = [padded_box(label) for label in labels]
    true_positives = 0
    for prediction in predictions:
        box = padded_box(prediction)
        best = 0.0
        for label_box in label_boxes:
            best = max(best, iou(box, label_box))
        if best >= 0.5:
            true_positives += 1
    return true_positives / len(predictions), true_positives / len(labels)
