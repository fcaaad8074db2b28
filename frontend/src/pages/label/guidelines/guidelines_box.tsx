import { useQuery } from "@tanstack/react-query";
import { Link } from "react-router";
import { guidelinesQuery } from "../../../api/queries";
import { useRights } from "../../../api/use_rights";
import { IconButton } from "../../../design/button";
import "./guidelines.css";

interface GuidelinesBoxProps {
  slug: string;
  onClose: () => void;
}

/** What counts as a straight line in this dataset, beside the image: one judges while reading. */
export function GuidelinesBox({ slug, onClose }: GuidelinesBoxProps) {
  const { data, isError } = useQuery(guidelinesQuery(slug));
  const { maintain } = useRights();
  const text = data?.guidelines ?? "";
  return (
    <section className="image-box guidelines" aria-label="Guidelines">
      <header>
        <h2>Guidelines</h2>
        <IconButton small icon="cross" label="Close" keys={["Shift", "G"]} side="end" onClick={onClose} />
      </header>
      <div className="guidelines__text">
        {data === undefined ? (
          <p className="muted">{isError ? "The guidelines couldn't be loaded." : "Loading…"}</p>
        ) : text === "" ? (
          <p className="muted">
            Nobody has written guidelines for this dataset yet.{" "}
            {maintain ? <Link to={`/datasets/${slug}?tab=team`}>Write them</Link> : null}
          </p>
        ) : (
          <p className="guidelines__body">{text}</p>
        )}
      </div>
    </section>
  );
}
