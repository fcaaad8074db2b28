import { expect, it } from "vitest";
import { changedAddress, readCameraAddress } from "./camera_address";

it("shows what the address says, and the usual where it says nothing known", () => {
  expect(readCameraAddress(new URLSearchParams("tab=maps&calibration=12&image=7&with=3"))).toEqual({
    part: "maps",
    calibration: 12,
    image: 7,
    other: 3,
  });
  expect(readCameraAddress(new URLSearchParams("tab=nonsense&calibration=-1&image=1e9"))).toEqual({
    part: "image",
    calibration: null,
    image: null,
    other: null,
  });
});

it("keeps what isn't changed, and writes nothing that is usual", () => {
  const before = new URLSearchParams("tab=lines&calibration=12");
  expect(changedAddress(before, { part: "image", image: 7 }).toString()).toBe("calibration=12&image=7");
  expect(changedAddress(before, { calibration: null }).toString()).toBe("tab=lines");
});
