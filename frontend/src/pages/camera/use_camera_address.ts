import { useCallback, useMemo } from "react";
import { useSearchParams } from "react-router";
import { changedAddress, readCameraAddress } from "./camera_address";

/** What the address says is shown; changing the part gives the history an entry, choosing an image doesn't. */
export function useCameraAddress() {
  const [parameters, setParameters] = useSearchParams();
  const address = useMemo(() => readCameraAddress(parameters), [parameters]);
  const set = useCallback(
    (changes: Parameters<typeof changedAddress>[1], replace = true) =>
      setParameters((old) => changedAddress(old, changes), { replace, preventScrollReset: true }),
    [setParameters],
  );
  const linkTo = useCallback(
    (changes: Parameters<typeof changedAddress>[1]) => `?${changedAddress(parameters, changes)}`,
    [parameters],
  );
  return { ...address, set, linkTo };
}
