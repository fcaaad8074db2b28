import { expect, test } from "vitest";
import { browserName } from "./browser_name";

const BEGINNING = "Mozilla/5.0";

test.each([
  [
    `${BEGINNING} (X11; Linux x86_64) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/140.0.0.0 Safari/537.36`,
    "Chrome on Linux",
  ],
  [`${BEGINNING} (Windows NT 10.0; Win64; x64) Chrome/140.0.0.0 Safari/537.36 Edg/140.0`, "Edge on Windows"],
  [
    `${BEGINNING} (Macintosh; Intel Mac OS X 10.15; rv:140.0) Gecko/20100101 Firefox/140.0`,
    "Firefox on macOS",
  ],
  [`${BEGINNING} (iPhone; CPU iPhone OS 18_0 like Mac OS X) Version/18.0 Safari/604.1`, "Safari on iOS"],
  [`${BEGINNING} (Linux; Android 15) Chrome/140.0.0.0 Mobile Safari/537.36`, "Chrome on Android"],
  ["curl/8.5.0", "curl/8.5.0"],
  [null, "Unknown browser"],
])("%s", (agent, name) => {
  expect(browserName(agent)).toBe(name);
});
