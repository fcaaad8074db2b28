import { describe, expect, it } from "vitest";
import { SHOWN_AT_FIRST } from "./layers";
import { readAddress, submissionPath, viewerPath, writeAddress } from "./viewer_address";

describe("the viewer's address", () => {
  it("is short where nothing was chosen", () => {
    expect(writeAddress(readAddress(""))).toBe("");
    expect(viewerPath(3, 7)).toBe("/submissions/3/images/7");
  });

  it.each([
    "?segment=p12",
    "?sort=-f1&search=night+5&order=near&show=fp-fn&segment=l3",
    "?show=none",
    "?with=8&side=b&view=both&differences=1&segment=p0",
  ])("comes back as it was: %s", (query) => {
    expect(writeAddress(readAddress(query))).toBe(query);
  });

  it("leads back to the list that one came from", () => {
    expect(submissionPath(3, readAddress(""))).toBe("/submissions/3");
    expect(submissionPath(3, readAddress("?sort=-fp&search=night"))).toBe(
      "/submissions/3?tab=images&sort=-fp&search=night",
    );
  });

  it("leaves out what only a comparison has", () => {
    expect(writeAddress(readAddress("?side=b&view=both&differences=1"))).toBe("");
  });

  it("ignores what it doesn't know", () => {
    expect(readAddress("?segment=x9&with=me&order=wild&show=fp-huh")).toEqual({
      sort: null,
      search: null,
      other: null,
      shown: { tp: false, fp: true, fn: false, ignored: false, found: false },
      segment: null,
      side: "a",
      order: null,
      sideBySide: false,
      differences: false,
    });
    expect(readAddress("").shown).toEqual(SHOWN_AT_FIRST);
  });
});
