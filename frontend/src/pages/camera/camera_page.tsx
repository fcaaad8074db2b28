import { useQuery } from "@tanstack/react-query";
import { useParams } from "react-router";
import { cameraQuery } from "../../api/camera_endpoints";
import { PageFrame } from "../../design/page_frame";
import { Fetched, Missing } from "../fetched";
import { CameraView } from "./camera_view";
import "../board_page.css";
import "./camera.css";

/** One camera: its lens, how well it is known, and the files that other tools read. */
export function CameraPage() {
  const { slug = "", cameraId = "" } = useParams();
  const id = /^\d+$/.test(cameraId) ? Number(cameraId) : 0;
  const camera = useQuery({ ...cameraQuery(id), refetchOnMount: "always" });
  const dataset = camera.data?.dataset ?? { slug, name: slug };
  return (
    <PageFrame
      crumbs={[
        { label: "Datasets", to: "/" },
        { label: dataset.name, to: `/datasets/${dataset.slug}` },
        { label: "Cameras", to: `/datasets/${dataset.slug}?tab=cameras` },
        { label: camera.data?.name ?? `Camera ${cameraId}` },
      ]}
    >
      <Fetched
        query={camera}
        missing={
          <Missing
            what="camera"
            list={{ to: `/datasets/${slug}?tab=cameras`, label: "Cameras of the dataset" }}
          >
            It may have gone with its dataset, or the address is mistyped.
          </Missing>
        }
        loading={
          <div className="camera-page" role="status" aria-label="Loading the camera">
            <div className="skeleton camera-page__loading-title" />
            <div className="skeleton camera-page__loading-facts" />
            <div className="skeleton camera-page__loading-view" />
          </div>
        }
      >
        {(known) => <CameraView key={known.id} camera={known} />}
      </Fetched>
    </PageFrame>
  );
}
