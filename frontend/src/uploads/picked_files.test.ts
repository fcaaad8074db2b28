import { describe, expect, it } from "vitest";
import { type Entry, readEntries, readFileList } from "./picked_files";

const PORTION = 2;

function file(name: string): Entry {
  return {
    isFile: true,
    isDirectory: false,
    name,
    file: (done: (file: File) => void) => done(new File(["x"], name)),
  } as Entry;
}

/** Gives its entries in portions, as browsers do. */
function folder(name: string, ...inside: Entry[]): Entry {
  return {
    isFile: false,
    isDirectory: true,
    name,
    createReader: () => {
      const left = [...inside];
      return { readEntries: (done: (entries: Entry[]) => void) => done(left.splice(0, PORTION)) };
    },
  } as Entry;
}

describe("readEntries", () => {
  it("reads folders to the bottom, in order, with their paths", async () => {
    const tree = folder("KITTI", file("2.png"), folder("deep", folder("er", file("3.png"))), file("1.png"));
    const picked = await readEntries([tree]);
    expect(picked.files.map(({ path }) => path)).toEqual([
      "KITTI/1.png",
      "KITTI/2.png",
      "KITTI/deep/er/3.png",
    ]);
    expect(picked.name).toBe("KITTI");
  });

  it("leaves out what is hidden, and counts other files of folders", async () => {
    const tree = folder(
      "d",
      file(".DS_Store"),
      folder("__MACOSX", file("a.png")),
      file("notes.txt"),
      file("a.png"),
    );
    const picked = await readEntries([tree]);
    expect(picked.files.map(({ path }) => path)).toEqual(["d/a.png"]);
    expect(picked.leftOut).toBe(1);
  });

  it("keeps a file that was dropped by itself, whatever it is: the server says what is wrong with it", async () => {
    const picked = await readEntries([file("notes.txt")]);
    expect(picked.files.map(({ path }) => path)).toEqual(["notes.txt"]);
    expect(picked.name).toBeNull();
  });

  it("names a dataset after a zip", async () => {
    expect((await readEntries([file("York Urban.zip")])).name).toBe("York Urban");
  });

  it("has no name for several things", async () => {
    expect((await readEntries([folder("a"), folder("b")])).name).toBeNull();
  });
});

describe("readFileList", () => {
  it("takes the paths of a chosen folder", () => {
    const image = new File(["x"], "1.png");
    Object.defineProperty(image, "webkitRelativePath", { value: "drive/images/1.png" });
    const picked = readFileList([image]);
    expect(picked.files.map(({ path }) => path)).toEqual(["drive/images/1.png"]);
    expect(picked.name).toBe("drive");
  });
});
