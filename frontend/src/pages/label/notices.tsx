import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Link } from "react-router";
import { startRun } from "../../api/endpoints";
import { asProblem } from "../../api/problem";
import { keys } from "../../api/queries";
import type { ImageDetail } from "../../api/types";
import { Button, buttonClass, IconButton } from "../../design/button";
import { formatQuantity } from "../../design/format";
import { Icon } from "../../design/icons";
import { Keys } from "../../design/kbd";
import { EmptyState, ErrorState } from "../../design/states";
import { toast } from "../../design/toast";

interface ReviewBannerProps {
  image: ImageDetail;
  kept: number;
  onReopen: () => void;
}

/** Says that the image isn't open any more. */
export function ReviewBanner({ image, kept, onReopen }: ReviewBannerProps) {
  const done = image.status === "done";
  return (
    <div className={`banner${done ? " banner--success" : ""}`} role="status">
      <Icon name={done ? "check" : "cross"} />
      <span>
        <strong>{done ? "Done." : "Discarded."}</strong>{" "}
        {done ? `${formatQuantity(kept, "line")} kept.` : image.reason}
      </span>
      <Button small tone="quiet" onClick={onReopen}>
        Reopen
      </Button>
    </div>
  );
}

interface LeftHintProps {
  undecided: number;
  onReject: () => void;
  onClose: () => void;
}

/** Enter was pressed too early; one key ends it. */
export function LeftHint({ undecided, onReject, onClose }: LeftHintProps) {
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

/** Why there is nothing to judge, and what to do about it. */
export function NoCandidates({ slug, image }: { slug: string; image: ImageDetail }) {
  const queryClient = useQueryClient();
  const run = useMutation({
    mutationFn: () => startRun(slug),
    onSuccess: () => queryClient.invalidateQueries({ queryKey: keys.image(image.id) }),
    onError: (error) => toast({ tone: "danger", message: asProblem(error).message }),
  });
  const start = (
    <Button tone="primary" icon="play" busy={run.isPending} onClick={() => run.mutate()}>
      Pre-label the dataset
    </Button>
  );
  if (image.error !== null && image.prelabel === "failed") {
    return <ErrorState title="Pre-labelling failed" error={image.error} actions={start} />;
  }
  switch (image.prelabel) {
    case "queued":
    case "running":
      return (
        <EmptyState
          icon="lines"
          title={image.prelabel === "queued" ? "Waiting its turn" : "Looking for lines"}
        >
          The candidates appear here by themselves.
        </EmptyState>
      );
    case "done":
      return (
        <EmptyState
          icon="lines"
          title="No candidates found"
          actions={
            <Link className={buttonClass()} to={`/datasets/${slug}`}>
              Run again with other parameters
            </Link>
          }
        >
          The run found no line that is long enough in this image. <Keys keys={["Enter"]} /> marks it as done.
        </EmptyState>
      );
    default:
      return (
        <EmptyState icon="lines" title="Not pre-labelled yet" actions={start}>
          A pre-labelling run finds the candidates that you then keep or reject.
        </EmptyState>
      );
  }
}
