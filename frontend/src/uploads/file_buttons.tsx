import { useRef } from "react";
import { Button } from "../design/button";
import { ACCEPTED } from "./file_kinds";
import { type Picked, readFileList } from "./picked_files";

interface FileButtonsProps {
  onPicked: (picked: Picked) => void;
  tone?: "default" | "primary";
  /** Endings that the file dialog offers. */
  accept?: string;
}

/** The ways to choose files for those who don't drag. */
export function FileButtons({ onPicked, tone = "default", accept = ACCEPTED }: FileButtonsProps) {
  const files = useRef<HTMLInputElement>(null);
  const folder = useRef<HTMLInputElement>(null);
  const take = (input: HTMLInputElement) => {
    const picked = readFileList(input.files ?? []);
    input.value = "";
    if (picked.files.length > 0) onPicked(picked);
  };
  return (
    <>
      <Button icon="upload" tone={tone} onClick={() => files.current?.click()}>
        Choose files
      </Button>
      <Button icon="folder" onClick={() => folder.current?.click()}>
        Choose a folder
      </Button>
      <input
        ref={files}
        type="file"
        multiple
        hidden
        accept={accept}
        aria-label="Files"
        onChange={(event) => take(event.currentTarget)}
      />
      <input
        ref={folder}
        type="file"
        hidden
        webkitdirectory=""
        aria-label="Folder"
        onChange={(event) => take(event.currentTarget)}
      />
    </>
  );
}
