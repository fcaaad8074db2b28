import { useState } from "react";
import { useNavigate } from "react-router";
import { listScoredImages } from "../../api/board_endpoints";
import type { Submission } from "../../api/board_types";
import { failed } from "../datasets/use_dataset_actions";

const WORST = "f1";

/** Leads to the image with the lowest F1; null where images aren't shown. */
export function useWorstImage({ id, status, can }: Submission) {
  const navigate = useNavigate();
  const [busy, setBusy] = useState(false);
  if (status !== "scored" || !can.see_details) return null;
  const open = async () => {
    setBusy(true);
    try {
      const page = await listScoredImages(id, { sort: WORST, search: null, cursor: null, limit: 1 });
      const first = page.items[0];
      if (first) navigate(`/submissions/${id}/images/${first.image_id}?sort=${WORST}`);
    } catch (error) {
      failed(error);
    }
    setBusy(false);
  };
  return { open, busy };
}
