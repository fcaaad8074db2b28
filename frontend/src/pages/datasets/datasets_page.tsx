import { useQuery } from "@tanstack/react-query";
import { useRef, useState } from "react";
import { Link, useNavigate } from "react-router";
import { listDatasets } from "../../api/endpoints";
import { configurationQuery, keys } from "../../api/queries";
import type { Dataset } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Button } from "../../design/button";
import { formatQuantity } from "../../design/format";
import { InlineEdit } from "../../design/inline_edit";
import { PageFrame } from "../../design/page_frame";
import { EmptyState, ErrorState } from "../../design/states";
import { FileDrop } from "../../uploads/file_drop";
import type { Picked } from "../../uploads/picked_files";
import { startUpload } from "../../uploads/start_upload";
import { UploadPanel } from "../../uploads/upload_panel";
import { useRefreshAfterUploads } from "../../uploads/use_uploads";
import { isActive } from "../run_text";
import { useArrowKeys } from "../use_arrow_keys";
import { useHotkeys } from "../use_hotkeys";
import { DatasetCard } from "./dataset_card";
import { DatasetSkeletons } from "./dataset_skeletons";
import { RecentlyDeleted } from "./recently_deleted";
import { failed, useDatasetActions } from "./use_dataset_actions";
import { Welcome } from "./welcome";
import "./datasets.css";

const SEARCH_FROM = 9;
const DENSE_FROM = 25;
const POLL_MS = 1_500;

export function DatasetsPage() {
  const datasets = useQuery({
    queryKey: keys.datasets,
    queryFn: () => listDatasets(),
    refetchInterval: (query) =>
      query.state.data?.some((dataset) => dataset.latest_run && isActive(dataset.latest_run))
        ? POLL_MS
        : false,
  });
  const { createFor } = useDatasetActions();
  const { maintain } = useRights();
  const navigate = useNavigate();
  useRefreshAfterUploads();

  const takeFiles = async (picked: Picked) => {
    if (picked.files.length === 0) return startUpload("", picked);
    try {
      const dataset = await createFor(picked.name ?? "Uploaded images");
      startUpload(dataset.slug, picked);
      navigate(`/datasets/${dataset.slug}`);
    } catch (error) {
      failed(error);
    }
  };

  return (
    <PageFrame crumbs={[{ label: "Datasets" }]}>
      <div className="datasets-page">
        {datasets.data ? (
          datasets.data.length === 0 ? (
            <FirstPage onPicked={takeFiles} />
          ) : (
            <DatasetCollection datasets={datasets.data} />
          )
        ) : datasets.isError ? (
          <ErrorState error={datasets.error} onRetry={() => datasets.refetch()} />
        ) : (
          <DatasetSkeletons />
        )}
        {datasets.data && maintain ? <RecentlyDeleted /> : null}
        <PageFoot />
      </div>
      {maintain ? <FileDrop label="Drop to make a new dataset" onPicked={takeFiles} /> : null}
      <UploadPanel />
    </PageFrame>
  );
}

function FirstPage({ onPicked }: { onPicked: (picked: Picked) => void }) {
  const { maintain } = useRights();
  if (maintain) return <Welcome onPicked={onPicked} />;
  return (
    <EmptyState icon="images" title="No datasets to look at">
      Whoever maintains this server hasn't published any. With a token, more may be here: sign in at the top.
    </EmptyState>
  );
}

function DatasetCollection({ datasets }: { datasets: Dataset[] }) {
  const [adding, setAdding] = useState(false);
  const [search, setSearch] = useState("");
  const searchField = useRef<HTMLInputElement>(null);
  const list = useRef<HTMLUListElement>(null);
  const { create } = useDatasetActions();
  const { maintain } = useRights();
  const navigate = useNavigate();
  useArrowKeys(list, ".dataset-card__link");
  useHotkeys({
    "/": () => searchField.current?.focus(),
    n: () => setAdding(maintain),
  });

  const wanted = search.trim().toLocaleLowerCase();
  const shown = datasets.filter(({ name, slug }) => `${name} ${slug}`.toLocaleLowerCase().includes(wanted));
  const dense = datasets.length >= DENSE_FROM;
  return (
    <>
      <header className="datasets-page__header">
        <div>
          <h1>Datasets</h1>
          <p className="muted numeric">{formatQuantity(datasets.length, "dataset")}</p>
        </div>
        <div className="datasets-page__tools">
          {datasets.length >= SEARCH_FROM ? (
            <input
              ref={searchField}
              className="input datasets-page__search"
              type="search"
              placeholder="Search  ( / )"
              aria-label="Search datasets"
              value={search}
              onChange={(event) => setSearch(event.target.value)}
              onKeyDown={(event) => {
                if (event.key === "Escape") setSearch("");
                if (event.key === "ArrowDown" || event.key === "Enter") {
                  list.current?.querySelector<HTMLElement>(".dataset-card__link")?.focus();
                  event.preventDefault();
                }
              }}
            />
          ) : null}
          {maintain ? (
            <Button tone="primary" icon="plus" onClick={() => setAdding(true)}>
              New dataset
            </Button>
          ) : null}
        </div>
      </header>
      {adding ? (
        <div className="datasets-page__new card">
          <InlineEdit
            label="Name of the new dataset"
            value=""
            placeholder="Name of the new dataset"
            submitLabel="Create"
            close={() => setAdding(false)}
            save={async (name) => navigate(`/datasets/${(await create(name)).slug}`)}
          />
          <p className="muted">Or drop a folder or zip anywhere: it becomes a dataset of that name.</p>
        </div>
      ) : null}
      {shown.length === 0 ? (
        <EmptyState
          icon="search"
          title="No dataset of that name"
          actions={<Button onClick={() => setSearch("")}>Show all</Button>}
        />
      ) : null}
      <ul ref={list} className={`dataset-cards${dense ? " dataset-cards--dense" : ""}`}>
        {shown.map((dataset) => (
          <DatasetCard key={dataset.slug} dataset={dataset} />
        ))}
      </ul>
    </>
  );
}

function PageFoot() {
  const configuration = useQuery(configurationQuery);
  return (
    <footer className="datasets-page__foot muted">
      <span>ClearLines {configuration.data?.version}</span>
      <span className="datasets-page__links">
        <Link to="/docs/scoring">How results are scored</Link>
        <Link to="/docs/api">API documentation</Link>
      </span>
    </footer>
  );
}
