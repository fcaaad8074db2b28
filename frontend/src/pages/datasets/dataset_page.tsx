import { useQuery } from "@tanstack/react-query";
import { Link, useParams } from "react-router";
import { listImages } from "../../api/endpoints";
import { keys } from "../../api/queries";
import { PageFrame } from "../../design/page_frame";
import { ErrorState, LoadingState } from "../../design/states";

export function DatasetPage() {
  const { slug = "" } = useParams();
  const images = useQuery({ queryKey: keys.images(slug), queryFn: () => listImages(slug) });
  return (
    <PageFrame crumbs={[{ label: "Datasets", to: "/" }, { label: slug }]}>
      {images.isPending ? <LoadingState label="Loading images" /> : null}
      {images.isError ? <ErrorState error={images.error} onRetry={() => images.refetch()} /> : null}
      <ul>
        {images.data?.items.map((image) => (
          <li key={image.id}>
            <Link to={`/datasets/${slug}/images/${image.id}`}>{image.name}</Link>
          </li>
        ))}
      </ul>
    </PageFrame>
  );
}
