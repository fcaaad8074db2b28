import { type ReactNode, useState } from "react";
import { Link, useNavigate } from "react-router";
import type { Dataset } from "../../api/types";
import { useRights } from "../../api/use_rights";
import { Button } from "../../design/button";
import { Ellipsis } from "../../design/ellipsis";
import { formatDay, formatQuantity } from "../../design/format";
import { Icon } from "../../design/icons";
import { InlineEdit } from "../../design/inline_edit";
import { Keys } from "../../design/kbd";
import { Popover } from "../../design/popover";
import { VerdictBar } from "../../design/progress";
import { ReviewBar, reviewText } from "../../design/review_bar";
import { FileButtons } from "../../uploads/file_buttons";
import type { Picked } from "../../uploads/picked_files";
import { useDatasetActions } from "../datasets/use_dataset_actions";
import { segmentsText } from "../labelled";
import { verdictText } from "../verdict_text";

interface DatasetHeaderProps {
  dataset: Dataset;
  running: boolean;
  prelabelOpen: boolean;
  onLabel: () => void;
  onPrelabel: () => void;
  onPicked: (picked: Picked) => void;
  exportMenu: ReactNode;
}

export function DatasetHeader(props: DatasetHeaderProps) {
  const { dataset, running, prelabelOpen, onLabel, onPrelabel, onPicked, exportMenu } = props;
  const { images, candidates, reviewed, verdicts } = dataset;
  const segments = segmentsText(dataset);
  const { label, maintain } = useRights();
  const labelFirst = candidates > 0 || running || !maintain;
  return (
    <header className="dataset-header">
      <div className="dataset-header__main">
        <Title dataset={dataset} />
        <p className="muted numeric">
          {formatQuantity(images, "image")}
          {segments === null ? null : ` · ${segments}`} · created {formatDay(dataset.created_at)}
        </p>
      </div>
      <div className="dataset-header__actions">
        {images > 0 ? (
          <>
            <Button
              tone={labelFirst ? "primary" : "default"}
              icon={label ? "lines" : "eye"}
              aria-keyshortcuts="L"
              onClick={onLabel}
            >
              {label ? "Label" : "View images"} <Keys keys={["L"]} />
            </Button>
            {maintain ? (
              <Button
                tone={labelFirst ? "default" : "primary"}
                icon="play"
                aria-expanded={prelabelOpen}
                onClick={onPrelabel}
              >
                Pre-label
              </Button>
            ) : null}
            {exportMenu}
            {maintain ? <AddImages onPicked={onPicked} /> : null}
          </>
        ) : null}
        <More dataset={dataset} />
      </div>
      {images > 0 ? (
        <div className="dataset-header__measures">
          <div>
            <ReviewBar counts={reviewed} />
            <p className="muted numeric">{reviewText(reviewed)}</p>
          </div>
          <div>
            <VerdictBar counts={verdicts} />
            <p className="muted numeric">{verdictText(verdicts)}</p>
          </div>
        </div>
      ) : null}
    </header>
  );
}

function AddImages({ onPicked }: { onPicked: (picked: Picked) => void }) {
  return (
    <Popover label="Add images" icon="plus">
      {(close) => (
        <div className="add-images">
          <p className="muted">Or drop files, folders or zips anywhere on the page.</p>
          <FileButtons
            onPicked={(picked) => {
              close();
              onPicked(picked);
            }}
          />
        </div>
      )}
    </Popover>
  );
}

function Title({ dataset }: { dataset: Dataset }) {
  const [renaming, setRenaming] = useState(false);
  const { rename } = useDatasetActions();
  const { maintain } = useRights();
  if (!maintain) {
    return (
      <h1 className="dataset-header__title">
        <Ellipsis text={dataset.name} end={12} />
      </h1>
    );
  }
  if (renaming) {
    return (
      <InlineEdit
        label="Name of the dataset"
        value={dataset.name}
        close={() => setRenaming(false)}
        save={(name) => rename(dataset, name)}
      />
    );
  }
  return (
    <h1 className="dataset-header__title">
      <button type="button" title="Rename" onClick={() => setRenaming(true)}>
        <Ellipsis text={dataset.name} end={12} />
        <Icon name="pencil" />
      </button>
    </h1>
  );
}

function More({ dataset }: { dataset: Dataset }) {
  const { remove } = useDatasetActions();
  const { label, maintain } = useRights();
  const navigate = useNavigate();
  return (
    <Popover label="More" icon="more" iconOnly tone="quiet">
      {() => (
        <>
          <Link className="menu-item dataset-header__link" to={`/datasets/${dataset.slug}/card`}>
            <Icon name="paper" /> Dataset card
          </Link>
          {label ? (
            <Link className="menu-item dataset-header__link" to={`/datasets/${dataset.slug}/suggestions`}>
              <Icon name="lines" /> Suggestions
            </Link>
          ) : null}
          <Link className="menu-item dataset-header__link" to="?tab=splits">
            <Icon name="podium" /> Splits and leaderboards
          </Link>
          {maintain ? (
            <button
              type="button"
              className="menu-item menu-item--danger"
              onClick={async () => (await remove(dataset)) && navigate("/")}
            >
              <Icon name="trash" /> Delete this dataset
            </button>
          ) : null}
        </>
      )}
    </Popover>
  );
}
