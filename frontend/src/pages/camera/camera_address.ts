/** What of a camera's page is shown, as its address says. */

export const PARTS = ["image", "maps", "lines", "parameters", "history", "reference", "export"] as const;
export type Part = (typeof PARTS)[number];

export const PART_NAMES: Record<Part, string> = {
  image: "Before and after",
  maps: "Maps",
  lines: "Lines",
  parameters: "Parameters",
  history: "History",
  reference: "Reference",
  export: "Export",
};

interface CameraAddress {
  part: Part;
  /** The calibration asked for; the latest one where it is null. */
  calibration: number | null;
  image: number | null;
  /** One that the shown one is compared with. */
  other: number | null;
}

type Changes = { part?: Part } & { [name in "calibration" | "image" | "other"]?: number | null };

const PARAMETERS = { part: "tab", calibration: "calibration", image: "image", other: "with" } as const;

export function readCameraAddress(parameters: URLSearchParams): CameraAddress {
  return {
    part: PARTS.find((part) => part === parameters.get(PARAMETERS.part)) ?? "image",
    calibration: whole(parameters.get(PARAMETERS.calibration)),
    image: whole(parameters.get(PARAMETERS.image)),
    other: whole(parameters.get(PARAMETERS.other)),
  };
}

/** The parameters after some changes; what is usual isn't written. */
export function changedAddress(parameters: URLSearchParams, changes: Changes): URLSearchParams {
  const next = new URLSearchParams(parameters);
  for (const name of Object.keys(changes) as (keyof Changes)[]) {
    const value = changes[name];
    if (value === null || value === undefined || value === "image") next.delete(PARAMETERS[name]);
    else next.set(PARAMETERS[name], String(value));
  }
  return next;
}

function whole(text: string | null): number | null {
  return text !== null && /^\d{1,15}$/.test(text) ? Number(text) : null;
}
