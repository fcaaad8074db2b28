import { useQueryClient } from "@tanstack/react-query";
import { changeSplit, deleteSplit, freezeAgain, restoreSplit } from "../../api/board_endpoints";
import { boardKeys } from "../../api/board_queries";
import type { Split } from "../../api/board_types";
import { toast } from "../../design/toast";
import { failed } from "../datasets/use_dataset_actions";

/** Changes of a split, with the lists that follow them. */
export function useSplitActions(split: Split) {
  const client = useQueryClient();
  const { slug, name, closes_at } = split;
  const key = `split-${slug}`;

  async function act(run: () => Promise<unknown>, done: () => void): Promise<void> {
    try {
      await run();
      done();
    } catch (error) {
      failed(error);
    }
    await client.invalidateQueries({ queryKey: boardKeys.splits });
  }

  async function rename(text: string): Promise<void> {
    await changeSplit(slug, { name: text });
    await client.invalidateQueries({ queryKey: boardKeys.splits });
  }

  const restore = () =>
    act(
      () => restoreSplit(slug),
      () => toast({ tone: "success", message: `${name} is back.`, key }),
    );

  const remove = () =>
    act(
      () => deleteSplit(slug),
      () =>
        toast({
          message: `${name} deleted, with its board.`,
          action: { label: "Undo", run: () => void restore() },
          duration: 10_000,
          key,
        }),
    );

  const reopen = () =>
    act(
      () => changeSplit(slug, { closes_at }),
      () => toast({ tone: "success", message: `${name} takes submissions again.`, key }),
    );

  const closeNow = () =>
    act(
      () => changeSplit(slug, { closes_at: new Date().toISOString() }),
      () =>
        toast({
          message: `${name} takes no further submissions.`,
          action: { label: "Undo", run: () => void reopen() },
          duration: 10_000,
          key,
        }),
    );

  const freezeAnew = () =>
    act(
      () => freezeAgain(slug),
      () =>
        toast({ tone: "success", message: `${name} has a new version; scores on the older ones stay.`, key }),
    );

  return { rename, remove, closeNow, freezeAnew };
}
