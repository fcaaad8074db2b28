import { useQuery } from "@tanstack/react-query";
import { useEffect, useMemo, useSyncExternalStore } from "react";
import { meQuery } from "../../../api/board_queries";
import { dropLease, type LeaseState, type Present, putLease } from "../../../api/people_endpoints";
import { firstPaint } from "../../../image_view/first_paint";
import { LeaseKeeper, mayDecide } from "../../../labelling/people/lease_keeper";
import { pageId } from "./page_id";

export interface Lease {
  /** Who holds the image, where it isn't whoever looks at it. */
  readonly holder: Present | null;
  /** Who else has it open. */
  readonly others: readonly Present[];
  /** Changes with each answer as long as others are there: what they decide is worth asking for then. */
  readonly news: string | null;
  readonly takeOver: () => Promise<void>;
}

const ALONE: Lease = { holder: null, others: [], news: null, takeOver: async () => undefined };

/** Says that this page has the image open, as long as it has; tells who else has. */
export function useLease(imageId: number | undefined): Lease {
  const me = useQuery(meQuery).data;
  const person = me?.can.label === true ? me.name : undefined;
  const keeper = useMemo(
    () => (imageId === undefined || person === undefined ? null : keeperOf(imageId)),
    [imageId, person],
  );
  useEffect(() => {
    if (keeper === null || imageId === undefined) return;
    let left = false;
    const onVisible = () => document.visibilityState === "visible" && keeper.renew();
    const onLeave = () => keeper.stop();
    // A page that comes out of the browser's memory is there again.
    const onReturn = () => keeper.start();
    firstPaint.whenPainted(imageId).then(() => left || keeper.start());
    document.addEventListener("visibilitychange", onVisible);
    window.addEventListener("pagehide", onLeave);
    window.addEventListener("pageshow", onReturn);
    return () => {
      left = true;
      document.removeEventListener("visibilitychange", onVisible);
      window.removeEventListener("pagehide", onLeave);
      window.removeEventListener("pageshow", onReturn);
      keeper.stop();
    };
  }, [keeper, imageId]);
  const state = useSyncExternalStore(
    keeper?.subscribe ?? subscribeToNothing,
    keeper?.getState ?? nothingKnown,
  );
  return useMemo(() => leaseOf(keeper, state), [keeper, state]);
}

function keeperOf(imageId: number): LeaseKeeper {
  return new LeaseKeeper({
    renew: (takeOver) => putLease(imageId, pageId(), takeOver),
    drop: () => dropLease(imageId, pageId()),
    every: (milliseconds, act) => {
      const timer = setInterval(act, milliseconds);
      return () => clearInterval(timer);
    },
  });
}

function leaseOf(keeper: LeaseKeeper | null, state: LeaseState | null): Lease {
  if (keeper === null || state === null) return ALONE;
  const others = state.present.filter((present) => !present.mine);
  if (others.length === 0 && mayDecide(state)) return ALONE;
  return {
    holder: mayDecide(state) ? null : state.holder,
    others,
    news: state.expires_at,
    takeOver: () => keeper.takeOver(),
  };
}

const subscribeToNothing = () => () => undefined;
const nothingKnown = () => null;
