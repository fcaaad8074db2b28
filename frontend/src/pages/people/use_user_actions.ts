import { useQueryClient } from "@tanstack/react-query";
import { useMemo } from "react";
import { changeUser } from "../../api/account_endpoints";
import { accountKeys } from "../../api/account_queries";
import type { User, UserChanges } from "../../api/account_types";
import { toast } from "../../design/toast";
import { failed } from "../datasets/use_dataset_actions";

/** Changes of accounts; each can be undone from the note that tells of it. */
export function useUserActions() {
  const client = useQueryClient();
  return useMemo(() => {
    async function change(user: User, changes: UserChanges, told: string, undo: UserChanges): Promise<void> {
      try {
        await changeUser(user.id, changes);
        toast({
          message: told,
          key: `user-${user.id}`,
          action: {
            label: "Undo",
            run: () => void change(user, undo, `${user.name} is as before.`, changes),
          },
          duration: 10_000,
        });
      } catch (error) {
        failed(error);
      }
      await client.invalidateQueries({ queryKey: accountKeys.users });
    }

    return {
      setRole: (user: User, role: User["role"]) =>
        change(user, { role }, `${user.name} is ${role} now.`, { role: user.role }),
      setDisabled: (user: User, disabled: boolean) =>
        change(
          user,
          { disabled },
          disabled
            ? `${user.name} is disabled and signed out everywhere.`
            : `${user.name} may sign in again.`,
          { disabled: !disabled },
        ),
    };
  }, [client]);
}
