/** The state of the server, for whoever looks after it. */

import { queryOptions } from "@tanstack/react-query";
import { client, unwrap } from "./client";
import type { components } from "./schema";

export type Status = components["schemas"]["Status"];

const POLL_MS = 3_000;

export const getStatus = () => unwrap(client.GET("/api/status"));

export const statusQuery = queryOptions({
  queryKey: ["status"],
  queryFn: getStatus,
  refetchInterval: POLL_MS,
});
