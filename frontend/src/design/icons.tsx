import type { SVGProps } from "react";

/* Drawn on a 16 x 16 grid with a stroke of 1.5; the colour is the text's. */
const PATHS = {
  check: "M3 8.5 6.5 12 13 4.5",
  cross: "M4 4l8 8M12 4l-8 8",
  question: "M5.5 6a2.5 2.5 0 1 1 3.6 2.2c-.7.4-1.1.9-1.1 1.6M8 12.4v.1",
  circle: "M8 3.2a4.8 4.8 0 1 1 0 9.6 4.8 4.8 0 0 1 0-9.6",
  undo: "M5.5 3 2.5 6l3 3M2.5 6h6.8a3.7 3.7 0 0 1 0 7.4H6",
  redo: "M10.5 3l3 3-3 3M13.5 6H6.7a3.7 3.7 0 0 0 0 7.4H10",
  left: "M10 3.5 5.5 8l4.5 4.5",
  right: "M6 3.5 10.5 8 6 12.5",
  up: "M3.5 10 8 5.5l4.5 4.5",
  down: "M3.5 6 8 10.5 12.5 6",
  plus: "M8 3v10M3 8h10",
  minus: "M3 8h10",
  fit: "M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10",
  keyboard: "M2 4.5h12v7H2zM4.5 7v.1M7 7v.1M9.5 7v.1M11.8 7v.1M5.5 9.3h5",
  sun: "M8 5.2a2.8 2.8 0 1 1 0 5.6 2.8 2.8 0 0 1 0-5.6M8 1.5v1M8 13.5v1M1.5 8h1M13.5 8h1M3.4 3.4l.7.7M11.9 11.9l.7.7M12.6 3.4l-.7.7M4.1 11.9l-.7.7",
  moon: "M13 9.6A5.6 5.6 0 0 1 6.4 3a5.6 5.6 0 1 0 6.6 6.6",
  auto: "M8 2.5a5.5 5.5 0 1 1 0 11zM8 2.5a5.5 5.5 0 0 0 0 11",
  warning: "M8 2.5 14.2 13H1.8zM8 6.5v3M8 11.2v.1",
  info: "M8 2.2a5.8 5.8 0 1 1 0 11.6A5.8 5.8 0 0 1 8 2.2M8 7.3v3.5M8 5.1v.1",
  image: "M2.5 3h11v10h-11zM2.5 11l3.2-3.2 2.6 2.6 2-2 3.2 3.2M10.3 5.7v.1",
  images: "M4.5 2.5h9v8h-9zM2.5 5v7.5H11",
  lines: "M2.5 11.5l11-7M2.5 7l6-3.5M7.5 13l6-3.5",
  upload: "M8 10.5V3M5 5.8 8 2.8l3 3M2.8 10v3.2h10.4V10",
  download: "M8 2.8v7.5M5 7.5l3 3 3-3M2.8 10v3.2h10.4V10",
  play: "M5 3.2v9.6l8-4.8z",
  stop: "M4 4h8v8H4z",
  retry: "M13 8a5 5 0 1 1-1.5-3.6M13 2.2v3h-3",
  trash: "M3 4.5h10M6.5 4.5v-2h3v2M4.5 4.5l.6 9h5.8l.6-9",
  pencil: "M3 13l.6-2.8 7.2-7.2 2.2 2.2-7.2 7.2zM9.6 4.2l2.2 2.2",
  folder: "M2 4h4l1.4 1.6H14V13H2z",
  search: "M7 2.8a4.2 4.2 0 1 1 0 8.4 4.2 4.2 0 0 1 0-8.4M10.2 10.2l3.3 3.3",
  filter: "M2.5 3.5h11L9.4 8.4v4.1l-2.8-1.4V8.4z",
  sort: "M5 3v10M2.8 10.8 5 13l2.2-2.2M11 13V3M8.8 5.2 11 3l2.2 2.2",
  camera: "M2 5h3l1-1.8h4L11 5h3v8H2zM8 6.8a2.2 2.2 0 1 1 0 4.4 2.2 2.2 0 0 1 0-4.4",
  grid: "M2.5 2.5h4v4h-4zM9.5 2.5h4v4h-4zM2.5 9.5h4v4h-4zM9.5 9.5h4v4h-4z",
  gridLarge: "M2.5 2.5h11v4.5h-11zM2.5 9h11v4.5h-11z",
  copy: "M5.5 5.5h8v8h-8zM3.5 10.5h-1v-8h8v1",
  clock: "M8 2.2a5.8 5.8 0 1 1 0 11.6A5.8 5.8 0 0 1 8 2.2M8 4.8V8l2.2 1.4",
  tag: "M2.5 2.5h5.2l5.8 5.8-5.2 5.2-5.8-5.8zM5.4 5.4v.1",
  more: "M3.5 8v.1M8 8v.1M12.5 8v.1",
  external: "M6 3H3v10h10v-3M9 3h4v4M13 3 7.5 8.5",
  podium: "M2.5 13V8.5h3.7V13M6.2 13V4h3.6v9M9.8 13v-6h3.7v6M1.5 13h13",
  chart: "M2 13.5h12M4 13V8.5M8 13V3.5M12 13V6.5",
  people:
    "M6 3.2a2.2 2.2 0 1 1 0 4.4 2.2 2.2 0 0 1 0-4.4M1.8 13c.4-2.4 2-3.6 4.2-3.6s3.8 1.2 4.2 3.6M10.4 3.6a2 2 0 0 1 0 3.9M11.6 9.7c1.5.4 2.4 1.5 2.7 3.3",
  person: "M8 2.8a2.6 2.6 0 1 1 0 5.2 2.6 2.6 0 0 1 0-5.2M2.8 13.4c.5-2.6 2.5-4 5.2-4s4.7 1.4 5.2 4",
  snow: "M8 2v12M2.8 5l10.4 6M2.8 11l10.4-6M6.3 3 8 4.4 9.7 3M6.3 13 8 11.6 9.7 13",
  link: "M6.6 9.4a2.6 2.6 0 0 0 3.7 0l2.4-2.4a2.6 2.6 0 0 0-3.7-3.7l-1 1M9.4 6.6a2.6 2.6 0 0 0-3.7 0L3.3 9a2.6 2.6 0 0 0 3.7 3.7l1-1",
  paper: "M4 2.5h5.5L12.5 5.5v8H4zM9.3 2.7v3h3M6.2 8.2h4M6.2 10.7h4",
  code: "M5.5 4.5 2 8l3.5 3.5M10.5 4.5 14 8l-3.5 3.5",
  lock: "M3.5 7.2h9v6.3h-9zM5.4 7.2V5a2.6 2.6 0 0 1 5.2 0v2.2",
  compare: "M5 2.5v11M11 2.5v11M2.5 5 5 2.5 7.5 5M8.5 11l2.5 2.5 2.5-2.5",
  eye: "M1.8 8S4 3.8 8 3.8 14.2 8 14.2 8 12 12.2 8 12.2 1.8 8 1.8 8M8 6.2a1.8 1.8 0 1 1 0 3.6 1.8 1.8 0 0 1 0-3.6",
  eyeOff:
    "M2.5 2.5l11 11M6.3 4a6 6 0 0 1 1.7-.2c4 0 6.2 4.2 6.2 4.2a11 11 0 0 1-2 2.4M4 5.4A11 11 0 0 0 1.8 8S4 12.2 8 12.2c.9 0 1.7-.2 2.4-.5",
  pointer: "M4 2.5v10.2l2.7-2.5 1.7 3.6 1.7-.8-1.7-3.5h3.7z",
  keepBrush:
    "M13.6 2.4 7.4 8.6M5.6 8.8c1.4-.2 2.4.8 2.2 2.2-.2 1.6-2 2.6-5.3 2.5 1.4-1 .9-4.3 3.1-4.7M2 4.6l1.6 1.7L6.8 3",
  rejectBrush:
    "M13.6 2.4 7.4 8.6M5.6 8.8c1.4-.2 2.4.8 2.2 2.2-.2 1.6-2 2.6-5.3 2.5 1.4-1 .9-4.3 3.1-4.7M2.2 2.4l3.6 3.6M5.8 2.4 2.2 6",
  turnBrush:
    "M13.6 2.4 7.4 8.6M5.6 8.8c1.4-.2 2.4.8 2.2 2.2-.2 1.6-2 2.6-5.3 2.5 1.4-1 .9-4.3 3.1-4.7M2 4.4h4.4L4.9 2.9M6.4 6.4H2l1.5 1.5",
  lasso:
    "M8 2.8c3.2 0 5.7 1.7 5.7 3.9s-2.5 3.9-5.7 3.9-5.7-1.7-5.7-3.9S4.8 2.8 8 2.8M4.9 9.9c-.9.4-1.1 1.5-.3 2 .8.4 1.8-.2 1.7-1.1M6 11.6c.2 1-.4 1.7-1.4 2",
  trace:
    "M3 12.8 12.6 4M1.6 12.8a1.4 1.4 0 1 0 2.8 0 1.4 1.4 0 0 0-2.8 0M11.6 3.4a1.4 1.4 0 1 0 2.8 0 1.4 1.4 0 0 0-2.8 0M9.5 12.5h4M11.5 10.5v4",
  cut: "M1.8 12.8 6.6 8.4M9.4 5.8l4.8-4.4M6.2 4.6l3.6 6.2",
  trim: "M1.8 12.8 8 7.2M10.2 5.2l.4-.4M12.6 3l.4-.4M6 4l4.2 6",
  join: "M1.6 13 6 9M10 5.4 14.4 1.4M6 9l4-3.6M6 6.2V9h2.8M7.2 5.4H10v2.8",
  extend: "M5 11l6-6M2 14l1-1M13 3l1-1M10 2h4v4M6 14H2v-4",
  saved: "M4.5 12.5a3 3 0 0 1-.3-6 4 4 0 0 1 7.6 0 3 3 0 0 1 .2 6zM6 9.3l1.5 1.5 2.7-3",
  saving: "M4.5 12.5a3 3 0 0 1-.3-6 4 4 0 0 1 7.6 0 3 3 0 0 1 .2 6zM8 10.8V7.4M6.5 8.8 8 7.3l1.5 1.5",
  offline:
    "M2.5 2.5l11 11M4.5 12.5a3 3 0 0 1-.3-6l.2-.7M6.6 4.3a4 4 0 0 1 5.2 2.2 3 3 0 0 1 1.8 4.6M11.5 12.5h-7",
} as const;

export type IconName = keyof typeof PATHS;

type IconProps = { name: IconName; size?: number } & Omit<SVGProps<SVGSVGElement>, "name">;

export function Icon({ name, size = 16, ...rest }: IconProps) {
  return (
    <svg
      width={size}
      height={size}
      viewBox="0 0 16 16"
      fill="none"
      stroke="currentColor"
      strokeWidth={name === "more" ? 2.2 : 1.5}
      strokeLinecap="round"
      strokeLinejoin="round"
      aria-hidden="true"
      focusable="false"
      {...rest}
    >
      <path d={PATHS[name]} />
    </svg>
  );
}

export function Logo({ size = 22 }: { size?: number }) {
  return (
    <svg width={size} height={size} viewBox="0 0 32 32" aria-hidden="true" focusable="false">
      <rect width="32" height="32" rx="8" fill="#1d4ed8" />
      <path d="M7 23 25 9" stroke="#fff" strokeWidth="3" strokeLinecap="round" />
      <path
        d="M7 12c5-3.6 11-5 18-3"
        stroke="#9ec1ff"
        strokeWidth="2"
        strokeLinecap="round"
        strokeDasharray="3 4"
        fill="none"
      />
      <circle cx="7" cy="23" r="3" fill="#fff" />
      <circle cx="25" cy="9" r="3" fill="#fff" />
    </svg>
  );
}
