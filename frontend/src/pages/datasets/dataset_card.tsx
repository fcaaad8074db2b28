import { useState } from "react";
import { Link } from "react-router";
import { thumbnailUrl } from "../../api/endpoints";
import type { Dataset } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Ellipsis } from "../../design/ellipsis";
import { formatDay, formatQuantity } from "../../design/format";
import { Icon } from "../../design/icons";
import { InlineEdit } from "../../design/inline_edit";
import { Popover } from "../../design/popover";
import { VerdictBar } from "../../design/progress";
import { ReviewBar, reviewText } from "../../design/review_bar";
import { cameLabelled, labelledText, segmentsText } from "../labelled";
import { RunState } from "../run_state";
import { verdictText } from "../verdict_text";
import { useDatasetActions } from "./use_dataset_actions";
import "./dataset_card.css";

/** A dataset at a glance; the whole card leads to it. */
export function DatasetCard({ dataset }: { dataset: Dataset }) {
  const [renaming, setRenaming] = useState(false);
  const { rename } = useDatasetActions();
  const { maintain } = useRights();
  const { slug, name, images, reviewed, verdicts, candidates, latest_run } = dataset;
  const labelled = cameLabelled(dataset);
  return (
    <li className="dataset-card card">
      <Cover dataset={dataset} />
      <div className="dataset-card__body">
        {renaming ? (
          <InlineEdit
            label="Name of the dataset"
            value={name}
            close={() => setRenaming(false)}
            save={(next) => rename(dataset, next)}
          />
        ) : (
          <div className="dataset-card__title">
            <h2>
              <Link className="dataset-card__link" to={`/datasets/${slug}`}>
                <Ellipsis text={name} />
              </Link>
            </h2>
            {maintain ? <Menu dataset={dataset} onRename={() => setRenaming(true)} /> : null}
          </div>
        )}
        <p className="dataset-card__facts muted numeric">
          {formatQuantity(images, "image")}
          {labelled ? ` · ${segmentsText(dataset)}` : null} · {formatDay(dataset.created_at)}
        </p>
        {images > 0 ? (
          <div className="dataset-card__measure">
            <ReviewBar counts={reviewed} />
            <p className="muted numeric">{reviewText(reviewed)}</p>
          </div>
        ) : null}
        {candidates > 0 ? (
          <div className="dataset-card__measure">
            <VerdictBar counts={verdicts} />
            <p className="muted numeric" title={verdictText(verdicts)}>
              {verdictText(verdicts)}
            </p>
          </div>
        ) : null}
        <div className="dataset-card__run">
          {latest_run ? (
            <RunState run={latest_run} />
          ) : (
            <span className="muted">
              {labelled ? labelledText(dataset) : images > 0 ? "Not pre-labelled" : "No images yet"}
            </span>
          )}
        </div>
      </div>
    </li>
  );
}

function Menu({ dataset, onRename }: { dataset: Dataset; onRename: () => void }) {
  const { remove } = useDatasetActions();
  return (
    <Popover label={`More for ${dataset.name}`} icon="more" iconOnly tone="quiet" small>
      {(close) => (
        <>
          <button
            type="button"
            className="menu-item"
            onClick={() => {
              close();
              onRename();
            }}
          >
            <Icon name="pencil" /> Rename
          </button>
          <button
            type="button"
            className="menu-item menu-item--danger"
            onClick={() => {
              close();
              void remove(dataset);
            }}
          >
            <Icon name="trash" /> Delete
          </button>
        </>
      )}
    </Popover>
  );
}

function Cover({ dataset }: { dataset: Dataset }) {
  const { cover } = dataset;
  if (cover.length === 0) {
    return (
      <div className="dataset-cover dataset-cover--empty">
        <Icon name="images" size={28} />
      </div>
    );
  }
  return (
    <div className={`dataset-cover dataset-cover--${cover.length}`}>
      {cover.map((id) => (
        <img key={id} src={thumbnailUrl(id, 320)} alt="" loading="lazy" decoding="async" />
      ))}
    </div>
  );
}
