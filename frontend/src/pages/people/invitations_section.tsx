import { useState } from "react";
import { revokeInvitation } from "../../api/account_endpoints";
import { accountKeys } from "../../api/account_queries";
import type { Invitation } from "../../api/account_types";
import { Badge, type BadgeTone } from "../../design/badge";
import { Button } from "../../design/button";
import { ColumnHeads } from "../../design/column_heads";
import { formatDate } from "../../design/format";
import { ShownOnce } from "../../design/shown_once";
import { TableScroll } from "../../design/table_scroll";
import { useFollowed } from "../use_followed";
import { InvitationForm } from "./invitation_form";
import { type InvitationState, invitationState } from "./invitation_state";

/** Links that make accounts: new ones, and those on their way. */
export function InvitationsSection({ invitations }: { invitations: readonly Invitation[] }) {
  const [address, setAddress] = useState<string | null>(null);
  const follow = useFollowed(accountKeys.invitations);
  return (
    <section className="section card" aria-labelledby="invitations-title">
      <h2 id="invitations-title">Invitations</h2>
      {address === null ? (
        <InvitationForm
          made={(link) => {
            void follow(async () => setAddress(link));
          }}
        />
      ) : (
        <ShownOnce
          label="Invitation link"
          text={address}
          hint="Send it to the person by a way that only they read. It is good once, and shown this once."
          close={() => setAddress(null)}
        />
      )}
      {invitations.length > 0 ? (
        <TableScroll label="Invitations">
          <table className="table">
            <ColumnHeads columns={["For", "Role", "By", "Good until", "State", ""]} />
            <tbody>
              {invitations.map((invitation) => {
                const { id, kind, name, role, created_by, expires_at } = invitation;
                const state = invitationState(invitation, Date.now());
                return (
                  <tr key={id}>
                    <th scope="row" className="people__name">
                      {kind === "reset" ? `New password of ${name}` : (name ?? "Anyone with the link")}
                    </th>
                    <td>{role ?? "–"}</td>
                    <td className="people__name">{created_by ?? "–"}</td>
                    <td>{formatDate(expires_at)}</td>
                    <td>
                      <Badge tone={STATE_TONES[state]}>{state}</Badge>
                    </td>
                    <td className="table__number">
                      {state === "open" ? (
                        <Button small onClick={() => void follow(() => revokeInvitation(id))}>
                          Take back
                        </Button>
                      ) : null}
                    </td>
                  </tr>
                );
              })}
            </tbody>
          </table>
        </TableScroll>
      ) : null}
    </section>
  );
}

const STATE_TONES = {
  open: "accent",
  used: "success",
  "taken back": "neutral",
  expired: "warning",
} as const satisfies Record<InvitationState, BadgeTone>;
