import { useEffect, useMemo, useRef, useState } from "react";

interface Shown {
  readonly keyList: boolean;
  /** Enter was pressed too early. */
  readonly leftHint: boolean;
  /** The reason for discarding is being asked for. */
  readonly discarding: boolean;
}

const NOTHING: Shown = { keyList: false, leftHint: false, discarding: false };

/** What lies beside or above the image; all but the key list belongs to one image. */
export function useOverlays(imageId: number) {
  const [shown, setShown] = useState(NOTHING);
  const latest = useRef(shown);
  latest.current = shown;

  // biome-ignore lint/correctness/useExhaustiveDependencies: another image begins without them
  useEffect(() => setShown(({ keyList }) => ({ ...NOTHING, keyList })), [imageId]);

  const control = useMemo(() => {
    const change = (part: Partial<Shown>) => setShown((before) => ({ ...before, ...part }));
    return {
      toggleKeyList: () => setShown((before) => ({ ...before, keyList: !before.keyList })),
      setLeftHint: (leftHint: boolean) => change({ leftHint }),
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
