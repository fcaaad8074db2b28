import { formatQuantity } from "../design/format";
import { toast } from "../design/toast";
import type { Picked } from "./picked_files";
import { uploads } from "./upload_start";

/** Sends picked files to a dataset; says so where there is nothing to send. */
export function startUpload(slug: string, picked: Picked): void {
  if (picked.files.length === 0) {
    toast({
      tone: "danger",
      message: "There is no image, label file or zip in what was chosen.",
      key: "upload",
    });
    return;
  }
  if (picked.leftOut > 0) {
    const files = formatQuantity(picked.leftOut, "other file");
    toast({ message: `${files} of the folder left out: no images, labels or zips.`, key: "upload" });
  }
  uploads.add(slug, picked.files);
}
