import type { Recall, ReviewStatus } from "../../../api/types";
import type { LabelActions } from "../../../labelling/commands";

/** What keys and buttons of the label page do. */
export interface PageActions extends LabelActions {
  goTo: (imageId: number) => void;
  setReview: (status: ReviewStatus, reason?: string) => Promise<boolean>;
  /** The image is done, and its labels are as complete as this. */
  answerRecall: (recall: Recall) => Promise<void>;
}

/** What may lie beside or above the image. */
export interface OverlayControl {
  toggleKeyList: () => void;
  toggleStages: () => void;
  toggleJump: () => void;
  toggleGuidelines: () => void;
  setLeftHint: (visible: boolean) => void;
  setRecall: (visible: boolean) => void;
  setDiscarding: (visible: boolean) => void;
  /** Closes whatever is open; false where nothing was. */
  close: () => boolean;
}
