import { useMemo, useState } from "react";
import { Link, useParams } from "react-router";
import { useRights } from "../../api/use_rights";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { ErrorState } from "../../design/states";
import { shortName } from "../../image_view/short_name";
import { outbox } from "../../labelling/outbox_start";
import { PLAIN_LOOK } from "../../labelling/views/image_look";
import { LabelWorkspace } from "./label_workspace";
import { JudgingContext, judgingOf } from "./people/judging";
import { Presence } from "./people/presence";
import { useLease } from "./people/use_lease";
import { SaveIndicator } from "./saving/save_indicator";
import { useLabelSession } from "./session/use_label_session";
import { WorkspaceOutline } from "./workspace_outline";
import "../../image_view/image_view.css";
import "../../image_view/panel.css";

/** The label page of one image; its address can be shared. */
export function LabelPage() {
  const { slug = "", imageId = "" } = useParams();
  const session = useLabelSession(slug, Number(imageId));
  const { image, error, retry } = session;
  const { label: may } = useRights();
  const lease = useLease(image?.id);
  // Here, since the workspace goes while an image that nothing was fetched of is waited for.
  const look = useState(PLAIN_LOOK);
  const judging = useMemo(() => judgingOf(may, lease.holder), [may, lease.holder]);
  return (
    <PageFrame
      scrolling={false}
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: image?.dataset.name ?? slug, to: `/datasets/${slug}` },
        { label: image === undefined ? "Image" : shortName(image.name) },
      ]}
      actions={
        <>
          <Presence others={lease.others} />
          <SaveIndicator outbox={outbox} />
        </>
      }
    >
      {image !== undefined ? (
        <JudgingContext value={judging}>
          <LabelWorkspace slug={slug} session={session} image={image} lease={lease} look={look} />
        </JudgingContext>
      ) : error ? (
        <ErrorState
          error={error}
          onRetry={retry}
          actions={
            <Link className={buttonClass()} to={`/datasets/${slug}`}>
              To the dataset
            </Link>
          }
        />
      ) : (
        <WorkspaceOutline />
      )}
    </PageFrame>
  );
}
