/** Query keys and options of accounts, invitations, tokens and the audit. */

import { infiniteQueryOptions, queryOptions } from "@tanstack/react-query";
import * as api from "./account_endpoints";
import type { AuditFilter } from "./account_types";

export const accountKeys = {
  providers: ["providers"] as const,
  account: ["account"] as const,
  sessions: ["account", "sessions"] as const,
  tokens: ["account", "tokens"] as const,
  users: ["users"] as const,
  serviceTokens: ["users", "tokens"] as const,
  invitations: ["invitations"] as const,
  audit: (filter: AuditFilter) => ["audit", filter] as const,
};

export const providersQuery = queryOptions({
  queryKey: accountKeys.providers,
  queryFn: api.listProviders,
  staleTime: Number.POSITIVE_INFINITY,
});
export const accountQuery = queryOptions({ queryKey: accountKeys.account, queryFn: api.getAccount });
export const sessionsQuery = queryOptions({ queryKey: accountKeys.sessions, queryFn: api.listSessions });
export const ownTokensQuery = queryOptions({ queryKey: accountKeys.tokens, queryFn: api.listOwnTokens });
export const usersQuery = queryOptions({ queryKey: accountKeys.users, queryFn: api.listUsers });
export const serviceTokensQuery = queryOptions({
  queryKey: accountKeys.serviceTokens,
  queryFn: api.listServiceTokens,
});
export const invitationsQuery = queryOptions({
  queryKey: accountKeys.invitations,
  queryFn: api.listInvitations,
});

/** Asked once: the answer says whether the link was good when the page was opened. */
export const invitationQuery = (secret: string) =>
  queryOptions({
    queryKey: ["invitations", "look", secret],
    queryFn: () => api.lookAtInvitation(secret),
    staleTime: Number.POSITIVE_INFINITY,
    retry: false,
  });

export const auditQuery = (filter: AuditFilter) =>
  infiniteQueryOptions({
    queryKey: accountKeys.audit(filter),
    queryFn: ({ pageParam }) => api.getAudit(filter, pageParam),
    initialPageParam: null as string | null,
    getNextPageParam: (page) => page.next_cursor,
  });
