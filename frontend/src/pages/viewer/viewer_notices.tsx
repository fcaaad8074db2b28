import type { ReactNode } from "react";
import { Icon, type IconName } from "../../design/icons";
import { Keys } from "../../design/kbd";
import type { MatchedImage } from "./matched_image";

/** What there is to say of an image that lacks one side. */
export function ViewerNotice({ image, bare }: { image: MatchedImage; bare: boolean }) {
  if (bare) {
    return (
      <Banner icon="eyeOff">
        All lines are hidden. <Keys keys={["H"]} /> shows them again.
      </Banner>
    );
  }
  const labels = image.detail.truth.length;
  const predictions = image.detail.predictions.length;
  if (labels === 0 && predictions === 0) {
    return <Banner icon="check">No labels and no predictions: nothing to find, nothing found.</Banner>;
  }
  if (predictions === 0) {
    return (
      <Banner icon="info">The submission has no predictions for this image: every label is a miss.</Banner>
    );
  }
  if (labels === 0) {
    return <Banner icon="info">The image has no labels: every prediction is a false positive.</Banner>;
  }
  return null;
}

function Banner({ icon, children }: { icon: IconName; children: ReactNode }) {
  return (
    <div className="banner banner--wrapping" role="status">
      <Icon name={icon} />
      <span className="viewer-notice">{children}</span>
    </div>
  );
}
