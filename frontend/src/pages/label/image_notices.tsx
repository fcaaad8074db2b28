import { ErrorState } from "../../design/states";
import { LoadingNotice } from "../../image_view/loading_notice";
import { TraceBanner } from "./drawing/trace_banner";
import { NoCandidates } from "./image/no_candidates";
import { LeaseBanner } from "./people/lease_banner";
import { StaleList } from "./people/stale_list";
import { RecallQuestion } from "./recall/recall_question";
import { StatusBanner } from "./review/status_banner";
import type { Workspace, WorkspaceParts } from "./use_workspace";

interface ImageNoticesProps extends WorkspaceParts {
  workspace: Workspace;
}

/** What is to be said of the image, above it. */
export function ImageNotices({ slug, session, image, lease, workspace }: ImageNoticesProps) {
  const { seen, drawing, shown, control, actions } = workspace;
  const { store } = session;
  const problem = seen.error ?? session.error;
  const empty = store !== null && store.getState().candidates.length === 0;
  return (
    <div className="image-notices">
      {problem ? (
        <div className="notice-card">
          <ErrorState error={problem} onRetry={seen.error ? seen.retry : session.retry} />
        </div>
      ) : seen.bitmap === null || store === null ? (
        <LoadingNotice />
      ) : null}
      {empty && !problem ? <NoCandidates slug={slug} image={image} /> : null}
      {drawing.tracing ? <TraceBanner session={drawing.session} /> : null}
      {store ? (
        <StatusBanner
          store={store}
          image={image}
          leftHint={shown.leftHint}
          onReopen={() => actions.setReview("open")}
          onReject={actions.rejectUndecided}
          onClose={() => control.setLeftHint(false)}
        />
      ) : null}
      {lease.holder ? <LeaseBanner holder={lease.holder} onTakeOver={lease.takeOver} /> : null}
      {store ? <StaleList imageId={image.id} store={store} /> : null}
      {shown.recall ? (
        <RecallQuestion onAnswer={actions.answerRecall} onClose={() => control.setRecall(false)} />
      ) : null}
    </div>
  );
}
