import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { ReactNode } from "react";
import { Link } from "react-router";
import { startRun } from "../../../api/endpoints";
import { asProblem } from "../../../api/problem";
import { keys } from "../../../api/queries";
import type { ImageDetail } from "../../../api/types";
import { useRights } from "../../../api/use_rights";
import { Button, buttonClass } from "../../../design/button";
import { sentence } from "../../../design/format";
import { Icon, type IconName } from "../../../design/icons";
import { Keys } from "../../../design/kbd";
import { toast } from "../../../design/toast";

interface NoticeProps {
  icon: IconName;
  title: string;
  children: ReactNode;
  action?: ReactNode;
}

/** Why there is nothing to judge, and what to do about it; the image itself stays in view. */
export function NoCandidates({ slug, image }: { slug: string; image: ImageDetail }) {
  const { maintain, label: judges } = useRights();
  if (image.status !== "open") return null;
  if (image.error !== null && image.prelabel === "failed") {
    const { message, hint } = image.error;
    return (
      <Notice
        icon="warning"
        title="Pre-labelling failed"
        action={maintain ? <StartRun slug={slug} image={image} only /> : null}
      >
        {sentence(message)} {hint ? sentence(hint) : null}
      </Notice>
    );
  }
  switch (image.prelabel) {
    case "queued":
    case "running":
      return (
        <Notice icon="lines" title={image.prelabel === "queued" ? "Waiting its turn" : "Looking for lines"}>
          The candidates appear here by themselves.
        </Notice>
      );
    case "done":
      return (
        <Notice
          icon="lines"
          title="No candidates found"
          action={
            maintain ? (
              <Link className={buttonClass("default", true)} to={`/datasets/${slug}`}>
                Run again with other parameters
              </Link>
            ) : null
          }
        >
          No line is long enough.{" "}
          {judges ? (
            <>
              <Keys keys={["Enter"]} /> marks the image as done.
            </>
          ) : null}
        </Notice>
      );
    default:
      return (
        <Notice
          icon="lines"
          title="Not pre-labelled yet"
          action={maintain ? <StartRun slug={slug} image={image} /> : null}
        >
          A run finds the candidates that you then keep or reject.
        </Notice>
      );
  }
}

function Notice({ icon, title, children, action }: NoticeProps) {
  return (
    <div className="banner banner--wrapping" role="status">
      <Icon name={icon} />
      <span>
        <strong>{title}.</strong> {children}
      </span>
      {action}
    </div>
  );
}

interface StartRunProps {
  slug: string;
  image: ImageDetail;
  /** This image alone; else the whole dataset, whose images say more about the lens together. */
  only?: boolean;
}

function StartRun({ slug, image, only = false }: StartRunProps) {
  const queryClient = useQueryClient();
  const run = useMutation({
    mutationFn: () => startRun(slug, only ? { image_ids: [image.id] } : {}),
    onSuccess: () => queryClient.invalidateQueries({ queryKey: keys.image(image.id) }),
    onError: (error) => toast({ tone: "danger", message: asProblem(error).message }),
  });
  return (
    <Button small tone="primary" icon="play" busy={run.isPending} onClick={() => run.mutate()}>
      {only ? "Try again" : "Pre-label the dataset"}
    </Button>
  );
}
