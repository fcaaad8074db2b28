import { useQueryClient } from "@tanstack/react-query";
import { useMemo } from "react";
import { deleteImages, type ImageChanges, restoreImages, updateImages } from "../../api/endpoints";
import { keys } from "../../api/queries";
import { assignImages } from "../../api/team_endpoints";
import { formatDay, formatQuantity } from "../../design/format";
import { toast } from "../../design/toast";
import { failed } from "../datasets/use_dataset_actions";

/** Changes of many images at once; each answers whether it was done. */
export function useImageActions(slug: string) {
  const client = useQueryClient();
  return useMemo(() => {
    const doing = async (action: () => Promise<void>): Promise<boolean> => {
      let done = true;
      try {
        await action();
      } catch (error) {
        failed(error);
        done = false;
      }
      await client.invalidateQueries({ queryKey: keys.dataset(slug) });
      return done;
    };
    const restore = (ids: number[]) =>
      doing(async () => {
        const { restored } = await restoreImages(slug, ids);
        toast({ tone: "success", message: `${formatQuantity(restored, "image")} restored.`, key: "images" });
      });
    const remove = (ids: number[]) =>
      doing(async () => {
        const { deleted, restorable_until } = await deleteImages(slug, ids);
        toast({
          message: `${formatQuantity(deleted, "image")} deleted, restorable until ${formatDay(restorable_until)}.`,
          action: { label: "Undo", run: () => void restore(ids) },
          duration: 10_000,
          key: "images",
        });
      });
    const change = (ids: number[], changes: ImageChanges) =>
      doing(async () => {
        const { updated } = await updateImages(slug, ids, changes);
        toast({ tone: "success", message: `${formatQuantity(updated, "image")} changed.`, key: "images" });
      });
    const assign = (ids: number[], person: string | null) =>
      doing(async () => {
        await assignImages(slug, { people: person === null ? [] : [person], mode: "to", image_ids: ids });
        const images = formatQuantity(ids.length, "image");
        toast({
          tone: "success",
          message:
            person === null ? `${images} nobody's in particular now.` : `${images} given to ${person}.`,
          key: "images",
        });
      });
    return { restore, remove, change, assign };
  }, [client, slug]);
}
