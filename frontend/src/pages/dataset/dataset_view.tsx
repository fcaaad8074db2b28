import { useQueryClient } from "@tanstack/react-query";
import { lazy, Suspense, useState } from "react";
import { Link, useNavigate, useSearchParams } from "react-router";
import { listImages } from "../../api/endpoints";
import { keys } from "../../api/queries";
import type { Dataset, Run } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { formatCount } from "../../design/format";
import { FileDrop } from "../../uploads/file_drop";
import type { Picked } from "../../uploads/picked_files";
import { startUpload } from "../../uploads/start_upload";
import { failed } from "../datasets/use_dataset_actions";
import { finishedCount } from "../run_text";
import { useHotkeys } from "../use_hotkeys";
import { CamerasTab } from "./cameras_tab";
import { DatasetHeader } from "./dataset_header";
import { EmptyDataset } from "./empty_dataset";
import { ExportMenu } from "./export_menu";
import { ImagesTab } from "./images_tab";
import { PrelabelPanel } from "./prelabel_panel";
import { RunStrip } from "./run_strip";
import { RunsTab } from "./runs_tab";
import { SplitsTab } from "./splits_tab";
import { useFollow } from "./use_follow";
import { useRuns } from "./use_runs";

const TeamTab = lazy(async () => ({ default: (await import("./team/team_tab")).TeamTab }));
const StatisticsTab = lazy(async () => ({
  default: (await import("./statistics/statistics_tab")).StatisticsTab,
}));

const COUNTS_MS = 2_000;
const TABS = ["images", "runs", "cameras", "splits", "team", "statistics"] as const;
type Tab = (typeof TABS)[number];

export function DatasetView({ dataset }: { dataset: Dataset }) {
  const { slug, images } = dataset;
  const [parameters] = useSearchParams();
  const tab = TABS.find((name) => name === parameters.get("tab")) ?? "images";
  const { runs, active } = useRuns(slug);
  const [prelabelling, setPrelabelling] = useState<{ ids: number[] } | null>(null);
  const navigate = useNavigate();
  const rights = useRights();
  useCountsFollow(slug, active);

  const label = async () => {
    try {
      // Whoever can't label goes through all images.
      const wanted = rights.label ? ({ status: "open", sort: "name" } as const) : ({ sort: "name" } as const);
      const first = (await listImages(slug, wanted, null, 1)).items[0];
      navigate(first ? `/datasets/${slug}/images/${first.id}` : `/datasets/${slug}/finished`);
    } catch (error) {
      failed(error);
    }
  };
  useHotkeys({
    l: () => void label(),
    enter: () => void label(),
  });
  const pick = (picked: Picked) => startUpload(slug, picked);
  const openPrelabel = (ids: number[] = []) => {
    setPrelabelling({ ids });
    document.querySelector(".frame__content")?.scrollTo({ top: 0 });
  };

  return (
    <div className="dataset-page">
      <DatasetHeader
        dataset={dataset}
        running={active !== null}
        prelabelOpen={prelabelling !== null}
        onLabel={label}
        onPrelabel={() => (prelabelling ? setPrelabelling(null) : openPrelabel())}
        onPicked={pick}
        exportMenu={<ExportMenu dataset={dataset} onShowOpen={() => navigate("?status=open")} />}
      />
      {prelabelling ? (
        <PrelabelPanel
          key={prelabelling.ids.length}
          dataset={dataset}
          selected={prelabelling.ids}
          onClose={() => setPrelabelling(null)}
          onStarted={() => setPrelabelling(null)}
        />
      ) : null}
      {active ? <RunStrip slug={slug} run={active} /> : null}
      {images === 0 && tab === "images" && parameters.get("status") !== "deleted" ? (
        <EmptyDataset onPicked={pick} />
      ) : (
        <>
          <Tabs tab={tab} images={images} runs={runs.data?.length} />
          {tab === "images" ? (
            <ImagesTab dataset={dataset} active={active} onPrelabel={openPrelabel} />
          ) : null}
          {tab === "runs" ? <RunsTab slug={slug} runs={runs} onPrelabel={() => openPrelabel()} /> : null}
          {tab === "cameras" ? <CamerasTab slug={slug} /> : null}
          {tab === "splits" ? <SplitsTab dataset={dataset} /> : null}
          <Suspense fallback={null}>
            {tab === "team" ? <TeamTab dataset={dataset} /> : null}
            {tab === "statistics" ? <StatisticsTab slug={slug} /> : null}
          </Suspense>
        </>
      )}
      {rights.maintain ? <FileDrop label={`Drop to add to ${dataset.name}`} onPicked={pick} /> : null}
    </div>
  );
}

function Tabs({ tab, images, runs }: { tab: Tab; images: number; runs: number | undefined }) {
  const entries: { name: Tab; text: string; count: number | undefined }[] = [
    { name: "images", text: "Images", count: images },
    { name: "runs", text: "Runs", count: runs },
    { name: "cameras", text: "Cameras", count: undefined },
    { name: "splits", text: "Splits", count: undefined },
    { name: "team", text: "Team", count: undefined },
    { name: "statistics", text: "Statistics", count: undefined },
  ];
  return (
    <nav className="tabs" aria-label="Parts of the dataset">
      {entries.map(({ name, text, count }) => (
        <Link
          key={name}
          className="tabs__tab"
          to={name === "images" ? "?" : `?tab=${name}`}
          aria-current={name === tab ? "page" : undefined}
        >
          {text}
          {count !== undefined ? <span className="tabs__count">{formatCount(count)}</span> : null}
        </Link>
      ))}
    </nav>
  );
}

/** While a run goes on, the dataset's own counts follow it, at a slower pace. */
function useCountsFollow(slug: string, active: Run | null): void {
  const client = useQueryClient();
  useFollow(active ? `${active.id} ${finishedCount(active)}` : null, COUNTS_MS, () => {
    void client.invalidateQueries({ queryKey: keys.dataset(slug), exact: true });
    void client.invalidateQueries({ queryKey: keys.facets(slug) });
  });
}
