import { useEffect, useMemo, useRef, useState } from "react";

interface Shown {
  readonly keyList: boolean;
  /** Enter was pressed too early. */
  readonly leftHint: boolean;
  /** It is being asked how complete the labels are. */
  readonly recall: boolean;
  /** The reason for discarding is being asked for. */
  readonly discarding: boolean;
  /** How the selected candidate was found. */
  readonly stages: boolean;
  /** An image is being looked for by its name. */
  readonly jump: boolean;
  /** What the dataset's maintainer has written for those who judge. */
  readonly guidelines: boolean;
}

const NOTHING: Shown = {
  keyList: false,
  leftHint: false,
  recall: false,
  discarding: false,
  stages: false,
  jump: false,
  guidelines: false,
};

/** What lies beside or above the image; what one reads along with all images stays, the rest belongs to one. */
export function useOverlays(imageId: number) {
  const [shown, setShown] = useState(NOTHING);
  const latest = useRef(shown);
  latest.current = shown;

  // biome-ignore lint/correctness/useExhaustiveDependencies: another image begins without them
  useEffect(
    () => setShown(({ keyList, stages, guidelines }) => ({ ...NOTHING, keyList, stages, guidelines })),
    [imageId],
  );

  const control = useMemo(() => {
    const change = (part: Partial<Shown>) => setShown((before) => ({ ...before, ...part }));
    return {
      toggleKeyList: () => setShown((before) => ({ ...before, keyList: !before.keyList })),
      toggleStages: () => setShown((before) => ({ ...before, stages: !before.stages })),
      toggleJump: () => setShown((before) => ({ ...before, jump: !before.jump })),
      toggleGuidelines: () => setShown((before) => ({ ...before, guidelines: !before.guidelines })),
      setLeftHint: (leftHint: boolean) => change({ leftHint }),
      setRecall: (recall: boolean) => change({ recall }),
      setDiscarding: (discarding: boolean) => change({ discarding }),
      close: () => {
        const open = Object.values(latest.current).includes(true);
        if (open) setShown(NOTHING);
        return open;
      },
    };
  }, []);
  return { shown, control };
}
