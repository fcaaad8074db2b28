import { createBrowserRouter } from "react-router";
import { NotFoundPage, PageFailed } from "./fallback_pages";

function NothingYet() {
  return null;
}

/** Each page is a chunk of its own, so that the label page doesn't wait for the others. */
export function makeRouter() {
  return createBrowserRouter([
    {
      errorElement: <PageFailed />,
      HydrateFallback: NothingYet,
      children: [
        {
          path: "/",
          lazy: async () => ({ Component: (await import("../pages/datasets/datasets_page")).DatasetsPage }),
        },
        {
          path: "/datasets/:slug",
          lazy: async () => ({ Component: (await import("../pages/dataset/dataset_page")).DatasetPage }),
        },
        {
          path: "/datasets/:slug/images/:imageId",
          lazy: async () => ({ Component: (await import("../pages/label/label_page")).LabelPage }),
        },
        {
          path: "/datasets/:slug/finished",
          lazy: async () => ({ Component: (await import("../pages/label/finished_page")).FinishedPage }),
        },
        {
          path: "/docs/api",
          lazy: async () => ({ Component: (await import("../pages/api_docs/api_docs_page")).ApiDocsPage }),
        },
        { path: "*", element: <NotFoundPage /> },
      ],
    },
  ]);
}
