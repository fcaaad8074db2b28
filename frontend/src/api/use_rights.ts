import { useQuery } from "@tanstack/react-query";
import { meQuery } from "./board_queries";
import type { Me } from "./board_types";

export type Rights = Me["can"];

const ALL: Rights = { admin: true, maintain: true, label: true, submit: true, see_hidden: true };

/** What whoever looks at the page may do; all of it until that is known, for the server refuses the rest anyway. */
export function useRights(): Rights {
  return useQuery(meQuery).data?.can ?? ALL;
}
