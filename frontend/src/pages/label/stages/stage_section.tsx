import { type RefObject, useEffect, useId, useRef } from "react";
import type { SegmentFacts } from "../../../api/types";
import type { Scene } from "../../../canvas/scene";
import type { CanvasView } from "../../../canvas/view";
import { Icon } from "../../../design/icons";
import { Keys } from "../../../design/kbd";
import { StageDetails } from "./stage_details";
import "./stages.css";

interface StageSectionProps {
  imageId: number;
  candidate: SegmentFacts;
  /** Of the candidate in the scene. */
  index: number;
  scene: Scene;
  viewRef: RefObject<CanvasView | null>;
  open: boolean;
  onToggle: () => void;
}

/** How the selected candidate was found, on request: here in words, on the image as strokes. */
export function StageSection({ open, onToggle, ...details }: StageSectionProps) {
  const section = useRef<HTMLDivElement>(null);
  const wasOpen = useRef(open);
  const contentId = useId();

  useEffect(() => {
    // Opened by its key it may lie below what the panel shows.
    if (open && !wasOpen.current) scrollToTop(section.current);
    wasOpen.current = open;
  }, [open]);

  return (
    <div className="stages" ref={section}>
      <button
        type="button"
        className="stages__toggle"
        aria-expanded={open}
        aria-controls={contentId}
        aria-keyshortcuts="I"
        onClick={onToggle}
      >
        <Icon name={open ? "down" : "right"} size={14} />
        <span>How it was found</span>
        <Keys keys={["I"]} />
      </button>
      <div id={contentId} hidden={!open}>
        {open ? <StageDetails {...details} /> : null}
      </div>
    </div>
  );
}

/** Scrolls the panel alone; `scrollIntoView` would move the page too. */
function scrollToTop(section: HTMLElement | null): void {
  const panel = section?.closest(".image-panel__scroll");
  if (!section || !panel) return;
  panel.scrollTop += section.getBoundingClientRect().top - panel.getBoundingClientRect().top;
}
