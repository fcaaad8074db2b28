import { describe, expect, it } from "vitest";
import { EVERYTHING, isFiltered, readView, toFilter, writeView } from "./image_view";

const parse = (text: string) => new URLSearchParams(text);

describe("the view in the address", () => {
  it("is everything by name where nothing is said", () => {
    expect(readView(parse(""))).toEqual({ ...EVERYTHING, sort: "name" });
    expect(isFiltered(readView(parse("sort=-name&tab=images")))).toBe(false);
  });

  it("comes back as it was written", () => {
    const view = {
      status: "done",
      prelabel: "failed",
      source: "A & B",
      sequence: "",
      camera: 3,
      assignee: "",
      person: "Mara",
      verdict: "ambiguous",
      min_score: 0.25,
      max_score: 1,
      search: "0 0/ü",
      sort: "-candidates",
    } as const;
    expect(readView(parse(writeView(parse(""), view).toString()))).toEqual(view);
  });

  it("leaves out what it can't mean", () => {
    expect(
      readView(
        parse("status=gone&camera=x&camera=2&sort=age&prelabel=&verdict=best&min_score=2&max_score=x"),
      ),
    ).toEqual({
      ...EVERYTHING,
      sort: "name",
    });
    expect(readView(parse("camera=-1")).camera).toBeNull();
  });

  it("writes no defaults, and keeps what isn't its own", () => {
    const next = writeView(parse("tab=images&status=open&sort=-name&search=a"), {
      status: null,
      sort: "name",
      search: "",
    });
    expect(next.toString()).toBe("tab=images");
  });

  it("tells images without a source from images of any source", () => {
    expect(readView(parse("source=")).source).toBe("");
    expect(readView(parse("")).source).toBeNull();
    expect(isFiltered(readView(parse("source=")))).toBe(true);
  });

  it("asks the server for deleted images apart from their status", () => {
    const filter = toFilter(readView(parse("status=deleted&search=a")));
    expect(filter).toMatchObject({ status: null, deleted: true, search: "a" });
    expect(toFilter(readView(parse("")))).toMatchObject({ deleted: false, search: null });
  });
});
