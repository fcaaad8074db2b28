import { useDeferredValue, useState } from "react";
import { KeyList } from "../../image_view/key_list";
import { type KeyHint, StatusStrip } from "../../image_view/status_strip";
import { COMMAND_GROUPS, COMMANDS } from "../../labelling/commands";
import { cssFilter } from "../../labelling/views/image_look";
import { DrawButtons } from "./drawing/draw_buttons";
import { GuidelinesBox } from "./guidelines/guidelines_box";
import { HintTip } from "./hints/hint_tip";
import { CanvasRegion } from "./image/canvas_region";
import { ImageNotices } from "./image_notices";
import { JumpBox } from "./jump/jump_box";
import { Announcer } from "./selection/announcer";
import { SidePanel } from "./side_panel";
import { ToolBar } from "./tools/tool_bar";
import { useWorkspace, type WorkspaceParts } from "./use_workspace";

const HINTS: readonly KeyHint[] = [
  ["Tab", "next"],
  ["K", "keep"],
  ["X", "reject"],
  ["A", "ambiguous"],
  ["S", "accept suggestions"],
  ["R", "reject the rest"],
  ["Enter", "done"],
];

const LOOKING_HINTS: readonly KeyHint[] = [
  ["Tab", "next line"],
  ["N", "next image"],
  ["P", "previous image"],
];

export function LabelWorkspace(parts: WorkspaceParts) {
  const { slug, image } = parts;
  const { store } = parts.session;
  const workspace = useWorkspace(parts);
  const { viewRef, focus, shown, control, seen, judges, drawing, actions } = workspace;
  const [scale, setScale] = useState(1);
  // The image is begun with first: what is around it is made while its lines are drawn.
  const furnished = useDeferredValue(true, false);

  function closeJump(): void {
    control.toggleJump();
    focus.enterImage();
  }

  return (
    <div className="image-page">
      <a className="skip-link" href="#label-panel">
        Skip to the review panel
      </a>
      <div className="image-stage">
        <CanvasRegion
          image={image}
          bitmap={seen.bitmap}
          scene={seen.scene}
          filter={cssFilter(seen.look)}
          store={store}
          viewRef={viewRef}
          regionRef={workspace.regionRef}
          onScale={setScale}
        />
        {store ? <Announcer store={store} /> : null}
        {furnished ? (
          <ToolBar>{judges ? <DrawButtons tracing={drawing.tracing} actions={actions} /> : null}</ToolBar>
        ) : (
          <div className="tool-bar" />
        )}
        <ImageNotices {...parts} workspace={workspace} />
        {shown.jump ? <JumpBox slug={slug} onGo={actions.goTo} onClose={closeJump} /> : null}
        {shown.guidelines ? <GuidelinesBox slug={slug} onClose={control.toggleGuidelines} /> : null}
        {shown.keyList ? (
          <KeyList commands={COMMANDS} groups={COMMAND_GROUPS} onClose={control.toggleKeyList} />
        ) : null}
        {furnished ? (
          <StatusStrip
            hints={judges ? HINTS : LOOKING_HINTS}
            tip={judges && store ? <HintTip image={image} store={store} /> : null}
            scale={scale}
            actions={actions}
          />
        ) : (
          <div className="status-strip" />
        )}
      </div>
      {furnished && store && seen.scene ? (
        <SidePanel
          slug={slug}
          image={image}
          store={store}
          scene={seen.scene}
          bitmap={seen.bitmap}
          actions={actions}
          viewRef={viewRef}
          suggestions={workspace.suggestions}
          stages={shown.stages && seen.shown !== "undistorted"}
          look={seen.look}
          onLook={seen.setLook}
          discarding={shown.discarding && image.status !== "discarded"}
          panelRef={workspace.panelRef}
        />
      ) : (
        <aside className="image-panel" aria-busy="true" />
      )}
    </div>
  );
}
