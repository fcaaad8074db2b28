import { Link, useParams } from "react-router";
import { buttonClass } from "../../design/button";
import { splitForEllipsis } from "../../design/format";
import { PageFrame } from "../../design/page_frame";
import { ErrorState, LoadingState } from "../../design/states";
import { LabelWorkspace } from "./label_workspace";
import { SaveIndicator } from "./save_indicator";
import { useLabelSession } from "./use_label_session";
import "./label.css";
import "./panel.css";

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
        { label: image === undefined ? "Image" : shortened(image.name) },
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

const LONGEST_BEGINNING = 40;
const END = 20;

/** A long name without its middle: names of one folder differ at their end. */
function shortened(name: string): string {
  const [beginning, end] = splitForEllipsis(name, END);
  return beginning.length <= LONGEST_BEGINNING ? name : `${beginning.slice(0, LONGEST_BEGINNING)}…${end}`;
}
