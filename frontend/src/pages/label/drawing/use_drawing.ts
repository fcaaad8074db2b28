import { type RefObject, useEffect, useMemo } from "react";
import { postTrace } from "../../../api/endpoints";
import type { ImageDetail } from "../../../api/types";
import type { Point } from "../../../canvas/geometry";
import type { CanvasView } from "../../../canvas/view";
import { toast } from "../../../design/toast";
import type { DrawingActions } from "../../../labelling/drawing/commands_drawing";
import { TraceSession } from "../../../labelling/drawing/trace_session";
import { TraceTool } from "../../../labelling/drawing/trace_tool";
import { unsavedLines } from "../../../labelling/drawing/unsaved_lines";
import type { LabelStore } from "../../../labelling/label_store";
import { toolBox } from "../../../labelling/tools/tools_start";
import { EDIT_TOAST } from "../actions/image_toasts";
import { useToolBoxState } from "../tools/use_tool_box";
import type { Edits } from "./use_edits";
import type { PointerPlaces } from "./use_pointer_places";

/** How far from the pointer the line to cut may be, and one to join (screen px). */
const CUT_REACH = 24;
const JOIN_REACH = 14;
const HINT_DURATION = 4_000;
const OTHER_VIEW = "Lines are drawn and cut in the plain view: press V";

interface DrawingParts {
  judges: boolean;
  image: ImageDetail;
  store: LabelStore | null;
  viewRef: RefObject<CanvasView | null>;
  pointer: PointerPlaces;
  edits: Edits;
  /** Whether places on the screen are places in the image, as they aren't in the undistorted view. */
  plain: boolean;
}

export interface Drawing {
  session: TraceSession;
  /** Whether the tool that traces is in hand. */
  tracing: boolean;
  actions: DrawingActions;
}

/** What hands draw on an image. */
export function useDrawing(parts: DrawingParts): Drawing {
  const { judges, image, store, viewRef, pointer, edits, plain } = parts;
  const tracing = useToolBoxState().chosen === "trace";

  const session = useMemo(
    () =>
      new TraceSession({
        trace: (wanted) => postTrace(image.id, wanted),
        save: (points, clientId) =>
          edits.make({ client_id: clientId, kind: "trace", replaces: [], adds: [points] }),
        scale: () => viewRef.current?.current.scale ?? 1,
        newId: () => crypto.randomUUID(),
      }),
    [image.id, edits, viewRef],
  );
  useTraceTool(session, judges && plain, image, viewRef);

  const { id, width, height } = image;
  useEffect(() => {
    if (!tracing) session.clear();
    // Until the first point is clicked, the server has found the image's edges.
    else prepare({ id, width, height });
  }, [tracing, session, id, width, height]);
  useUnsavedLine(session, id);

  const actions = useMemo<DrawingActions>(() => {
    function change(kind: "cut" | "trim"): void {
      const at = pointer();
      const line = at === null ? null : lineAt(store, viewRef.current, at);
      if (!plain) say(OTHER_VIEW);
      else if (at === null || line === null) say(`Point at the line to ${kind}, then press the key`);
      else edits.change(kind, [line], at);
    }

    function join(): void {
      const ids = selectedIds(store);
      const at = pointer();
      const hovered = at === null ? undefined : viewRef.current?.linesNear(at, JOIN_REACH)[0]?.index;
      const other = hovered === undefined ? undefined : store?.getState().candidates[hovered]?.id;
      if (ids.length === 1 && other !== undefined && other !== ids[0]) ids.push(other);
      if (ids.length === 2) edits.change("join", ids);
      else say("Select two lines to join: click one, then the other with Shift");
    }

    function extend(): void {
      const ids = selectedIds(store);
      if (ids.length === 1) edits.change("extend", ids);
      else say("Select one line to extend: click it");
    }

    return {
      toggleTrace: () => {
        if (plain) toolBox.toggle("trace");
        else say(OTHER_VIEW);
      },
      removePoint: () => {
        if (toolBox.getState().chosen === "trace") session.removeLast();
      },
      cutLine: () => change("cut"),
      trimLine: () => change("trim"),
      joinLines: join,
      extendLine: extend,
    };
  }, [store, viewRef, pointer, plain, session, edits]);

  return { session, tracing: tracing && judges && plain, actions };
}

/** Has the server read the image; what it answers is of no use. */
function prepare({ id, width, height }: Pick<ImageDetail, "id" | "width" | "height">): void {
  const points: [number, number][] = [
    [0, 0],
    [width - 1, height - 1],
  ];
  postTrace(id, { points, straight: true }).catch(() => undefined);
}

/** Puts the tool that traces into the tool box. */
function useTraceTool(
  session: TraceSession,
  usable: boolean,
  { width, height }: ImageDetail,
  viewRef: RefObject<CanvasView | null>,
): void {
  useEffect(() => {
    if (!usable) return;
    const tool = new TraceTool({
      session,
      accept: () => session.accept(),
      now: () => performance.now(),
      inside: ({ x, y }: Point) => ({ x: within(x, width), y: within(y, height) }),
    });
    const stops = [toolBox.add("trace", tool), session.subscribe(() => viewRef.current?.redrawTool())];
    return () => {
      for (const stop of stops) stop();
    };
  }, [session, usable, width, height, viewRef]);
}

/** Keeps a line that is left on an image until one comes back, and the tab open as long as one couldn't be saved. */
function useUnsavedLine(session: TraceSession, imageId: number): void {
  useEffect(() => {
    const left = unsavedLines.take(imageId);
    if (left.length > 0) toolBox.choose("trace");
    for (const click of left) session.click(click);
    const warn = (event: BeforeUnloadEvent) => {
      const { clicks, problem } = session.getState();
      if (clicks.length > 1 && problem !== null && problem.code !== "no-edge") event.preventDefault();
    };
    window.addEventListener("beforeunload", warn);
    return () => {
      window.removeEventListener("beforeunload", warn);
      unsavedLines.leave(imageId, session.getState().clicks);
    };
  }, [session, imageId]);
}

function within(place: number, size: number): number {
  return Math.min(Math.max(place, -0.5), size - 0.5);
}

function say(message: string): void {
  toast({ key: EDIT_TOAST, message, duration: HINT_DURATION });
}

function selectedIds(store: LabelStore | null): number[] {
  const state = store?.getState();
  return (state?.selection ?? []).flatMap((index) => state?.candidates[index]?.id ?? []);
}

/** The selected line, if it is near, else the nearest one. */
function lineAt(store: LabelStore | null, view: CanvasView | null, at: Point): number | null {
  if (store === null || view === null) return null;
  const { candidates, selected } = store.getState();
  const hits = view.linesNear(at, CUT_REACH);
  const index = hits.find((hit) => hit.index === selected)?.index ?? hits[0]?.index;
  return index === undefined ? null : (candidates[index]?.id ?? null);
}
