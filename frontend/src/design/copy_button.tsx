import { useState } from "react";
import { IconButton } from "./button";
import { toast } from "./toast";

const SHOWN_MS = 1_500;

export function CopyButton({ text, label }: { text: string; label: string }) {
  const [copied, setCopied] = useState(false);
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(text);
      setCopied(true);
      setTimeout(() => setCopied(false), SHOWN_MS);
    } catch {
      toast({ tone: "danger", message: "The browser doesn't allow copying here; select the text instead." });
    }
  };
  return (
    <IconButton
      small
      side="end"
      icon={copied ? "check" : "copy"}
      label={copied ? "Copied" : label}
      onClick={copy}
    />
  );
}
