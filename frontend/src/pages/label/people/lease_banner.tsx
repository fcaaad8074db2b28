import { useState } from "react";
import type { Present } from "../../../api/people_endpoints";
import { Button } from "../../../design/button";
import { Icon } from "../../../design/icons";

interface LeaseBannerProps {
  holder: Present;
  onTakeOver: () => Promise<void>;
}

/** Another person holds the image: one looks on, or takes it over. */
export function LeaseBanner({ holder, onTakeOver }: LeaseBannerProps) {
  const [busy, setBusy] = useState(false);
  const takeOver = () => {
    setBusy(true);
    onTakeOver().finally(() => setBusy(false));
  };
  return (
    <div className="banner lease-banner" role="status">
      <Icon name="person" />
      <span>
        <strong>{holder.person ?? "Someone else"}</strong> is at this image. You see what is decided.
      </span>
      <Button small busy={busy} onClick={takeOver}>
        Take over
      </Button>
    </div>
  );
}
