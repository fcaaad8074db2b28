import { keepPreviousData, useQuery } from "@tanstack/react-query";
import { type KeyboardEvent, useEffect, useId, useRef, useState } from "react";
import { listImages, thumbnailUrl } from "../../../api/endpoints";
import { keys } from "../../../api/queries";
import type { ImageSummary } from "../../../api/types";
import { ReviewBadge } from "../../../design/badge";
import { formatCount } from "../../../design/format";
import { useSettled } from "../../../design/use_settled";
import "./jump.css";

const MOST = 8;
/** Typing goes on while the last letters are looked up (ms). */
const PAUSE = 120;

interface JumpBoxProps {
  slug: string;
  onGo: (imageId: number) => void;
  onClose: () => void;
}

/** Goes to an image by part of its name. */
export function JumpBox({ slug, onGo, onClose }: JumpBoxProps) {
  const [typed, setTyped] = useState("");
  const search = useSettled(typed.trim(), "", PAUSE);
  const [active, setActive] = useState(0);
  const input = useRef<HTMLInputElement>(null);
  const listId = useId();
  const { data, isPending, isError } = useQuery({
    queryKey: [...keys.images(slug), "jump", search],
    queryFn: () => listImages(slug, search === "" ? {} : { search }, null, MOST),
    placeholderData: keepPreviousData,
  });
  const found = data?.items ?? [];
  const current = Math.min(active, Math.max(found.length - 1, 0));

  useEffect(() => input.current?.focus({ preventScroll: true }), []);

  function onKeyDown(event: KeyboardEvent): void {
    if (event.key === "Escape") onClose();
    else if (event.key === "ArrowDown") setActive(Math.min(current + 1, found.length - 1));
    else if (event.key === "ArrowUp") setActive(Math.max(current - 1, 0));
    else if (event.key === "Enter" && found[current] !== undefined) onGo(found[current].id);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  return (
    <search className="jump" aria-label="Go to an image" onKeyDown={onKeyDown}>
      <input
        ref={input}
        className="input"
        role="combobox"
        aria-label="Part of an image's name"
        aria-expanded="true"
        aria-controls={listId}
        aria-activedescendant={found.length === 0 ? undefined : `${listId}-${current}`}
        placeholder="Part of an image's name"
        value={typed}
        onChange={(event) => {
          setTyped(event.target.value);
          setActive(0);
        }}
        onBlur={(event) => {
          if (!event.currentTarget.closest(".jump")?.contains(event.relatedTarget)) onClose();
        }}
      />
      <div id={listId} role="listbox" aria-label="Images" className="jump__list">
        {found.map((image, place) => (
          <Entry
            key={image.id}
            id={`${listId}-${place}`}
            image={image}
            selected={place === current}
            onGo={() => onGo(image.id)}
          />
        ))}
      </div>
      <p className="jump__note muted" role="status">
        {isError
          ? "The images couldn't be looked up."
          : isPending
            ? "Looking…"
            : found.length === 0
              ? `No image's name holds “${search}”.`
              : found.length < (data?.total ?? 0)
                ? `${formatCount(data?.total ?? 0)}${data?.total_exact ? "" : "+"} images; type on to narrow them down`
                : "↑ ↓ to choose, Enter to go, Esc to stay"}
      </p>
    </search>
  );
}

interface EntryProps {
  id: string;
  image: ImageSummary;
  selected: boolean;
  onGo: () => void;
}

function Entry({ id, image, selected, onGo }: EntryProps) {
  return (
    <button
      type="button"
      id={id}
      role="option"
      aria-selected={selected}
      tabIndex={-1}
      className="jump__entry"
      title={image.name}
      onClick={onGo}
    >
      <img src={thumbnailUrl(image.id, 160)} alt="" />
      <span className="jump__name">{image.name}</span>
      <ReviewBadge status={image.status} />
    </button>
  );
}
