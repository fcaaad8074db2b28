import type { ImageDetail } from "../../../api/types";
import { useRights } from "../../../api/use_rights";
import { Button, IconButton } from "../../../design/button";
import { formatQuantity } from "../../../design/format";
import { Icon } from "../../../design/icons";
import { Keys } from "../../../design/kbd";
import type { LabelStore } from "../../../labelling/label_store";
import { useLabelState } from "../session/use_store";

interface StatusBannerProps {
  store: LabelStore;
  image: ImageDetail;
  leftHint: boolean;
  onReopen: () => void;
  onReject: () => void;
  onClose: () => void;
}

/** How far the review of the image is, where that has to be said. */
export function StatusBanner({ store, image, leftHint, onReopen, onReject, onClose }: StatusBannerProps) {
  const { counts } = useLabelState(store);
  if (image.status !== "open") return <ReviewBanner image={image} kept={counts.keep} onReopen={onReopen} />;
  if (leftHint && counts.undecided > 0) {
    return <LeftHint undecided={counts.undecided} onReject={onReject} onClose={onClose} />;
  }
  return null;
}

interface ReviewBannerProps {
  image: ImageDetail;
  kept: number;
  onReopen: () => void;
}

/** Says that the image isn't open any more. */
function ReviewBanner({ image, kept, onReopen }: ReviewBannerProps) {
  const done = image.status === "done";
  const { label: judges } = useRights();
  return (
    <div className={`banner${done ? " banner--success" : ""}`} role="status">
      <Icon name={done ? "check" : "cross"} />
      <span>
        <strong>{done ? "Done." : "Discarded."}</strong>{" "}
        {done ? `${formatQuantity(kept, "line")} kept.` : image.reason}
      </span>
      {judges ? (
        <Button small tone="quiet" onClick={onReopen}>
          Reopen
        </Button>
      ) : null}
    </div>
  );
}

interface LeftHintProps {
  undecided: number;
  onReject: () => void;
  onClose: () => void;
}

/** Enter was pressed too early; one key ends it. */
function LeftHint({ undecided, onReject, onClose }: LeftHintProps) {
  return (
    <div className="banner" role="status">
      <Icon name="info" />
      <span>
        <strong>{formatQuantity(undecided, "candidate")}</strong> undecided. This is the first of them.
      </span>
      <Button small onClick={onReject}>
        Reject all <Keys keys={["R"]} />
      </Button>
      <IconButton small icon="cross" label="Close" onClick={onClose} />
    </div>
  );
}
