/** One function per API call about accounts, invitations, tokens and the audit. */

import type { AuditFilter, UserChanges } from "./account_types";
import type { Role } from "./board_types";
import { client, unwrap } from "./client";

export const signInWithPassword = (name: string, password: string) =>
  unwrap(client.POST("/api/session", { body: { name, password } }));
export const listProviders = () => unwrap(client.GET("/api/session/providers"));

/** Returns the provider's address, where the browser is to go. */
export const startWithProvider = async (invitation: string): Promise<string> =>
  (await unwrap(client.POST("/api/session/openid/start", { body: { next: "/", invitation } }))).address;

export const getAccount = () => unwrap(client.GET("/api/account"));
export const changeAccount = (changes: { email: string }) =>
  unwrap(client.PATCH("/api/account", { body: changes }));
export const changePassword = (current: string | null, wanted: string) =>
  unwrap(client.POST("/api/account/password", { body: { current, new: wanted } }));
export const unlinkIdentity = (identity_id: number) =>
  unwrap(client.DELETE("/api/account/identities/{identity_id}", { params: { path: { identity_id } } }));
export const listSessions = () => unwrap(client.GET("/api/account/sessions"));
export const endSession = (session_id: number) =>
  unwrap(client.DELETE("/api/account/sessions/{session_id}", { params: { path: { session_id } } }));
export const listOwnTokens = () => unwrap(client.GET("/api/account/tokens"));
/** Returns the token itself, which is told this once. */
export const makeOwnToken = async (label: string, role: Role, days: number | null): Promise<string> =>
  (await unwrap(client.POST("/api/account/tokens", { body: { label, role, days } }))).token;
export const endOwnToken = (token_id: number) =>
  unwrap(client.DELETE("/api/account/tokens/{token_id}", { params: { path: { token_id } } }));

export const lookAtInvitation = (secret: string) =>
  unwrap(client.POST("/api/invitations/look", { body: { secret } }));
export const acceptInvitation = (secret: string, name: string | null, password: string) =>
  unwrap(client.POST("/api/invitations/accept", { body: { secret, name, password } }));

export const listUsers = () => unwrap(client.GET("/api/users"));
export const changeUser = (user_id: number, changes: UserChanges) =>
  unwrap(client.PATCH("/api/users/{user_id}", { params: { path: { user_id } }, body: changes }));
export const resetUser = (user_id: number) =>
  unwrap(client.POST("/api/users/{user_id}/reset", { params: { path: { user_id } } }));
export const listServiceTokens = () => unwrap(client.GET("/api/users/tokens"));
export const revokeToken = (token_id: number) =>
  unwrap(client.DELETE("/api/users/tokens/{token_id}", { params: { path: { token_id } } }));
export const listInvitations = () => unwrap(client.GET("/api/invitations"));
export const makeInvitation = (role: Role, name: string | null) =>
  unwrap(client.POST("/api/invitations", { body: { role, name } }));
export const revokeInvitation = (invitation_id: number) =>
  unwrap(client.DELETE("/api/invitations/{invitation_id}", { params: { path: { invitation_id } } }));

export const getAudit = (filter: AuditFilter, cursor: string | null) =>
  unwrap(client.GET("/api/audit", { params: { query: { ...filter, cursor, limit: 100 } } }));
