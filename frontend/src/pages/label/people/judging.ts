import { createContext, useContext } from "react";
import type { Present } from "../../../api/people_endpoints";
import { LOOKING_ONLY } from "./looking_only";

/** Whether candidates can be judged on this page now, and if not, why. */
export interface Judging {
  readonly judges: boolean;
  readonly why: string | null;
}

export const JudgingContext = createContext<Judging>({ judges: true, why: null });

export const useJudging = (): Judging => useContext(JudgingContext);

/**
 * @param may Whether the role allows it.
 * @param holder Another person who holds the image.
 */
export function judgingOf(may: boolean, holder: Present | null): Judging {
  if (!may) return { judges: false, why: LOOKING_ONLY };
  if (holder === null) return { judges: true, why: null };
  return {
    judges: false,
    why: `${holder.person ?? "Someone else"} is at this image. Take it over to judge.`,
  };
}
