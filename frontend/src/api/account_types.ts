/** The shapes of accounts, invitations, tokens and the audit, under the names the pages use. */

import type { components } from "./schema";

type Schemas = components["schemas"];

export type Account = Schemas["AccountAnswer"];
export type WebSession = Schemas["SessionAnswer"];
export type OwnToken = Schemas["OwnToken"];
export type InvitationLook = Schemas["InvitationSeen"];
export type User = Schemas["UserAnswer"];
export type ServiceToken = Schemas["AnyToken"];
export type Invitation = Schemas["InvitationAnswer"];
export type AuditEntry = Schemas["AuditLine"];
export type UserChanges = { role?: User["role"]; disabled?: boolean };
export type AuditFilter = { person?: string; kind?: string; dataset?: string };
