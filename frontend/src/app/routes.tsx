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
          path: "/datasets/:slug/cameras/:cameraId",
          lazy: async () => ({ Component: (await import("../pages/camera/camera_page")).CameraPage }),
        },
        {
          path: "/datasets/:slug/finished",
          lazy: async () => ({ Component: (await import("../pages/label/finished_page")).FinishedPage }),
        },
        {
          path: "/datasets/:slug/suggestions",
          lazy: async () => ({
            Component: (await import("../pages/suggestions/suggestions_page")).SuggestionsPage,
          }),
        },
        {
          path: "/datasets/:slug/second/:imageId",
          lazy: async () => ({ Component: (await import("../pages/second/second_page")).SecondPage }),
        },
        {
          path: "/datasets/:slug/differences",
          lazy: async () => ({
            Component: (await import("../pages/differences/differences_page")).DifferencesPage,
          }),
        },
        {
          path: "/datasets/:slug/card",
          lazy: async () => ({ Component: (await import("../pages/card/card_page")).CardPage }),
        },
        {
          path: "/splits",
          lazy: async () => ({ Component: (await import("../pages/splits/splits_page")).SplitsPage }),
        },
        {
          path: "/splits/:split",
          lazy: async () => ({ Component: (await import("../pages/board/board_page")).BoardPage }),
        },
        {
          path: "/splits/:split/submit",
          lazy: async () => ({ Component: (await import("../pages/submit/submit_page")).SubmitPage }),
        },
        {
          path: "/submissions/:id",
          lazy: async () => ({
            Component: (await import("../pages/submission/submission_page")).SubmissionPage,
          }),
        },
        {
          path: "/submissions/:id/images/:splitImageId",
          lazy: async () => ({ Component: (await import("../pages/viewer/viewer_page")).ViewerPage }),
        },
        {
          path: "/methods/:slug",
          lazy: async () => ({ Component: (await import("../pages/method/method_page")).MethodPage }),
        },
        {
          path: "/sign-in",
          lazy: async () => ({ Component: (await import("../pages/sign_in/sign_in_page")).SignInPage }),
        },
        {
          path: "/invitation",
          lazy: async () => ({
            Component: (await import("../pages/invitation/invitation_page")).InvitationPage,
          }),
        },
        {
          path: "/account",
          lazy: async () => ({ Component: (await import("../pages/account/account_page")).AccountPage }),
        },
        {
          path: "/people",
          lazy: async () => ({ Component: (await import("../pages/people/people_page")).PeoplePage }),
        },
        {
          path: "/audit",
          lazy: async () => ({ Component: (await import("../pages/audit/audit_page")).AuditPage }),
        },
        {
          path: "/status",
          lazy: async () => ({ Component: (await import("../pages/status/status_page")).StatusPage }),
        },
        {
          path: "/docs/scoring",
          lazy: async () => ({
            Component: (await import("../pages/scoring_docs/scoring_docs_page")).ScoringDocsPage,
          }),
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
