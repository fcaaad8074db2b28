import { useState } from "react";
import { useNavigate } from "react-router";
import { getImage } from "../../api/endpoints";
import { asProblem } from "../../api/problem";
import { useRights } from "../../api/use_rights";
import { sendToReview } from "../../api/viewer_endpoints";
import { toast } from "../../design/toast";
import type { ReviewState } from "./line_section";
import type { MatchedImage, MatchedLine } from "./matched_image";

type Sent = Readonly<Record<string, "sending" | "sent">>;

/** The notice leads to what was sent: there must be time to take that way (ms). */
const LONG_ENOUGH = 12_000;

interface ReviewParts {
  submission: number;
  imageId: number;
  image: MatchedImage | undefined;
  line: MatchedLine | null;
}

/** Sends the selected false positive to the dataset, where people judge it like any candidate. */
export function useReview({ submission, imageId, image, line }: ReviewParts) {
  const navigate = useNavigate();
  const [sent, setSent] = useState<Sent>({});
  const key = `${submission}/${imageId}/${line?.name}`;
  const target = image?.detail.review_target ?? null;
  const { label: judges } = useRights();
  const possible = judges && line?.layer === "fp" && target !== null;
  const state: ReviewState = possible ? (sent[key] ?? "possible") : "impossible";

  async function send(): Promise<void> {
    if (!judges) {
      toast({ key: "review", message: "Sending lines to review needs the role annotator" });
      return;
    }
    if (line === null || line.layer !== "fp") {
      toast({ key: "review", message: "Only a false positive can be sent to review" });
      return;
    }
    if (target === null) {
      toast({ key: "review", message: "This image isn't in a dataset that takes candidates any more" });
      return;
    }
    if (state !== "possible") return;
    setSent((before) => ({ ...before, [key]: "sending" }));
    try {
      const answer = await sendToReview(submission, imageId, [Number(line.name.slice(1))]);
      setSent((before) => ({ ...before, [key]: "sent" }));
      const { dataset, name } = await getImage(answer.image_id);
      toast({
        key: "review",
        tone: "success",
        message: `${answer.sent > 0 ? "Now" : "Already"} a candidate of ${name} in ${dataset.name}`,
        action: {
          label: "Open the review",
          run: () => navigate(`/datasets/${dataset.slug}/images/${answer.image_id}`),
        },
        duration: LONG_ENOUGH,
      });
    } catch (error) {
      setSent((before) => without(before, key));
      toast({ key: "review", tone: "danger", message: asProblem(error).message });
    }
  }

  return { state, send };
}

/** What failed on its way can be sent again; what has arrived can't. */
function without(sent: Sent, key: string): Sent {
  return Object.fromEntries(Object.entries(sent).filter(([name, state]) => name !== key || state === "sent"));
}
