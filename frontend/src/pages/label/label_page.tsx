import { Link, useParams } from "react-router";
import { buttonClass } from "../../design/button";
import { PageFrame } from "../../design/page_frame";
import { ErrorState, LoadingState } from "../../design/states";
import { shortName } from "../../image_view/short_name";
import { LabelWorkspace } from "./label_workspace";
import { SaveIndicator } from "./save_indicator";
import { useLabelSession } from "./use_label_session";
import "../../image_view/image_view.css";
import "../../image_view/panel.css";

/** The label page of one image; its address can be shared. */
export function LabelPage() {
  const { slug = "", imageId = "" } = useParams();
  const session = useLabelSession(slug, Number(imageId));
  const { image, error, retry } = session;
  return (
    <PageFrame
      scrolling={false}
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: image?.dataset.name ?? slug, to: `/datasets/${slug}` },
        { label: image === undefined ? "Image" : shortName(image.name) },
      ]}
      actions={<SaveIndicator />}
    >
      {image !== undefined ? (
        <LabelWorkspace slug={slug} session={session} image={image} />
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
        <LoadingState label="Loading the image" />
      )}
    </PageFrame>
  );
}
