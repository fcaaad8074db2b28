import { describe, expect, it } from "vitest";
import { RequestFailed } from "../api/problem";
import type { UploadReport } from "../api/types";
import type { FileToSend, SendOptions } from "../api/upload";
import { UploadQueue } from "./upload_queue";

const NOTHING: UploadReport = { added: [], existing: [], failed: [], labels: 0 };

interface Sent {
  files: readonly FileToSend[];
  options: SendOptions;
  answer: (report: UploadReport) => void;
  refuse: (error: unknown) => void;
}

function setUp(parallel = 2) {
  const sent: Sent[] = [];
  const stored: string[] = [];
  const queue = new UploadQueue({
    send: (_, files, options) =>
      new Promise((answer, refuse) => {
        options.signal.addEventListener("abort", () => refuse(new DOMException("", "AbortError")));
        sent.push({ files, options, answer, refuse });
      }),
    now: () => 0,
    limits: { files: 2, bytes: 1_000, wholeBytes: 1_000 },
    parallel,
    onStored: (slug) => stored.push(slug),
  });
  return { queue, sent, stored };
}

const pick = (...paths: string[]): FileToSend[] =>
  paths.map((path) => ({ path, file: new File(["12345"], path.split("/").at(-1) ?? path) }));
const settled = () => new Promise((resolve) => setTimeout(resolve));
const error = { code: "invalid-image", message: "broken", where: null, expected: null, hint: null };
const statesOf = (queue: UploadQueue) => queue.snapshot.items.map((item) => item.state);

describe("UploadQueue", () => {
  it("sends a few batches at a time", async () => {
    const { queue, sent, stored } = setUp();
    queue.add("kitti", pick("1.png", "2.png", "3.png", "4.png", "5.png"));
    expect(sent.map(({ files }) => files.length)).toEqual([2, 2]);
    sent[0]?.answer(NOTHING);
    await settled();
    expect(sent).toHaveLength(3);
    for (const request of sent) request.answer(NOTHING);
    await settled();
    expect(queue.snapshot.active).toBe(false);
    expect(queue.snapshot.counts.added).toBe(5);
    expect(stored).toEqual(["kitti", "kitti", "kitti"]);
  });

  it("tells from the bytes sent how far each file is", () => {
    const { queue, sent } = setUp();
    queue.add("kitti", pick("1.png", "2.png"));
    sent[0]?.options.onProgress(70, 100);
    expect(queue.snapshot.items.map((item) => item.sent)).toEqual([5, 2]);
    expect(queue.snapshot.bytes).toBe(10);
  });

  it("gives each file its own outcome", async () => {
    const { queue, sent } = setUp();
    queue.add("kitti", pick("f/1.png", "f/2.png"));
    sent[0]?.answer({
      ...NOTHING,
      existing: [{ name: "f/1", image_id: 7 }],
      failed: [{ name: "f/2.png", error }],
    });
    await settled();
    expect(statesOf(queue)).toEqual(["existing", "failed"]);
    expect(queue.snapshot.items[1]?.error?.message).toBe("broken");
  });

  it("lists what failed inside a zip", async () => {
    const { queue, sent } = setUp();
    queue.add("kitti", pick("all.zip"));
    sent[0]?.answer({ ...NOTHING, failed: [{ name: "k/bad.png", error }] });
    await settled();
    expect(queue.snapshot.items.map(({ path, state }) => [path, state])).toEqual([
      ["all.zip", "added"],
      ["all.zip › k/bad.png", "failed"],
    ]);
  });

  it("takes the reasons out of a refusal, and sends the failed ones again", async () => {
    const { queue, sent } = setUp();
    queue.add("kitti", pick("1.png", "2.png"));
    const details = { failed: [{ name: "1.png", error }] };
    sent[0]?.refuse(
      new RequestFailed({
        title: "",
        status: 422,
        code: "invalid-input",
        message: "none could be used",
        details,
      }),
    );
    await settled();
    expect(queue.snapshot.items.map((item) => item.error?.message)).toEqual(["broken", "none could be used"]);
    queue.retry();
    expect(statesOf(queue)).toEqual(["sending", "sending"]);
    sent[1]?.answer(NOTHING);
    await settled();
    expect(statesOf(queue)).toEqual(["added", "added"]);
  });

  it("cancels what is under way and what waits, and keeps what has arrived", async () => {
    const { queue, sent } = setUp(1);
    queue.add("kitti", pick("1.png", "2.png", "3.png", "4.png", "5.png"));
    sent[0]?.answer(NOTHING);
    await settled();
    queue.cancel();
    await settled();
    expect(statesOf(queue)).toEqual(["added", "added", "cancelled", "cancelled", "cancelled"]);
    expect(queue.snapshot.active).toBe(false);
    queue.clear();
    expect(queue.snapshot.items).toEqual([]);
  });
});
