import type { Role } from "../api/board_types";
import { ROLES } from "./roles";

/** The roles up to one, from the least on, for a select. */
export function RoleOptions({ most = "admin" }: { most?: Role }) {
  return ROLES.slice(0, ROLES.indexOf(most) + 1).map((role) => (
    <option key={role} value={role}>
      {role}
    </option>
  ));
}
