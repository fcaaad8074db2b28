import { useState } from "react";
import { signOut } from "../api/board_endpoints";
import { asProblem } from "../api/problem";
import { Button } from "./button";
import { sentence } from "./format";
import { useSigningIn } from "./use_signing_in";

export function SignOut({ close }: { close: () => void }) {
  const enter = useSigningIn();
  const [problem, setProblem] = useState<string | null>(null);
  const leave = async () => {
    try {
      await enter(signOut);
      close();
    } catch (error) {
      setProblem(sentence(asProblem(error).message));
    }
  };
  return (
    <>
      <Button onClick={leave}>Sign out</Button>
      {problem ? (
        <p className="field__error" role="alert">
          {problem}
        </p>
      ) : null}
    </>
  );
}
