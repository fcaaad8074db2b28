import { useEffect, useRef, useState } from "react";
import { Icon } from "../design/icons";
import { toast } from "../design/toast";
import { droppedEntries, type Picked, readEntries } from "./picked_files";
import "./uploads.css";

interface FileDropProps {
  /** What a drop does: "Drop to add to KITTI". */
  label: string;
  /** What can be dropped. */
  hint?: string;
  onPicked: (picked: Picked) => void;
}

/** Takes files dropped anywhere on the page, and says so while they hang over it. */
export function FileDrop({ label, hint = "Images, folders, zips, label files", onPicked }: FileDropProps) {
  const [hovering, setHovering] = useState(false);
  const latest = useRef(onPicked);
  latest.current = onPicked;

  useEffect(() => {
    // Each element under the pointer reports entering and leaving; the page is left when they are even.
    let depth = 0;
    const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    const onEnter = (event: DragEvent) => {
      if (!hasFiles(event)) return;
      depth += 1;
      setHovering(true);
    };
    const onLeave = (event: DragEvent) => {
      if (!hasFiles(event)) return;
      depth = Math.max(0, depth - 1);
      if (depth === 0) setHovering(false);
    };
    const onOver = (event: DragEvent) => {
      if (!hasFiles(event) || !event.dataTransfer) return;
      event.preventDefault();
      event.dataTransfer.dropEffect = "copy";
    };
    const onDrop = (event: DragEvent) => {
      if (!hasFiles(event) || !event.dataTransfer) return;
      event.preventDefault();
      depth = 0;
      setHovering(false);
      readEntries(droppedEntries(event.dataTransfer)).then(
        (picked) => latest.current(picked),
        () => toast({ tone: "danger", message: "The browser couldn't read what was dropped." }),
      );
    };
    window.addEventListener("dragenter", onEnter);
    window.addEventListener("dragleave", onLeave);
    window.addEventListener("dragover", onOver);
    window.addEventListener("drop", onDrop);
    return () => {
      window.removeEventListener("dragenter", onEnter);
      window.removeEventListener("dragleave", onLeave);
      window.removeEventListener("dragover", onOver);
      window.removeEventListener("drop", onDrop);
    };
  }, []);

  return hovering ? (
    <div className="file-drop">
      <div className="file-drop__label">
        <Icon name="upload" size={28} />
        <strong>{label}</strong>
        <span>{hint}</span>
      </div>
    </div>
  ) : null;
}
