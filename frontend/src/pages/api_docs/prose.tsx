import type { ReactNode } from "react";

/** Paragraphs of a docstring, with `code` set apart. */
export function Prose({ text }: { text: string }) {
  const paragraphs = text.trim().split(/\n\s*\n/);
  return paragraphs.map((paragraph) => <p key={paragraph}>{withCode(paragraph)}</p>);
}

/** Text with what stands between single or double backquotes as code. */
export function withCode(text: string): ReactNode[] {
  const shown: ReactNode[] = [];
  let end = 0;
  for (const mark of text.matchAll(/``?([^`]+)``?/g)) {
    shown.push(text.slice(end, mark.index), <code key={mark.index}>{mark[1]}</code>);
    end = mark.index + mark[0].length;
  }
  return [...shown, text.slice(end)];
}
