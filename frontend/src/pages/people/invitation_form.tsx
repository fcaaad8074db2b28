import { useState } from "react";
import { makeInvitation } from "../../api/account_endpoints";
import type { Role } from "../../api/board_types";
import { Button } from "../../design/button";
import { FormProblem } from "../../design/form_problem";
import { RoleOptions } from "../../design/role_options";
import { MAY } from "../../design/roles";
import { useSentForm } from "../../design/use_sent_form";

/** @param made Given the link, at the one moment when it is known. */
export function InvitationForm({ made }: { made: (address: string) => void }) {
  const [role, setRole] = useState<Role>("annotator");
  const [name, setName] = useState("");
  const { onSubmit, busy, problem } = useSentForm(async () => {
    const invitation = await makeInvitation(role, name.trim() === "" ? null : name.trim());
    made(invitation.address);
  });
  return (
    <form className="people__form" onSubmit={onSubmit}>
      <label className="field">
        <span className="field__label">Role</span>
        <select className="input" value={role} onChange={(event) => setRole(event.target.value as Role)}>
          <RoleOptions />
        </select>
      </label>
      <label className="field">
        <span className="field__label">Name</span>
        <input
          className="input"
          placeholder="They choose it"
          maxLength={80}
          value={name}
          onChange={(event) => setName(event.target.value)}
        />
      </label>
      <Button type="submit" tone="primary" icon="link" busy={busy}>
        Make a link
      </Button>
      <span className="muted people__may">{MAY[role]}</span>
      <FormProblem text={problem} />
    </form>
  );
}
