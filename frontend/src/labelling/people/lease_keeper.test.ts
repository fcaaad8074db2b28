import { describe, expect, it } from "vitest";
import type { LeaseState } from "../../api/people_endpoints";
import { LeaseKeeper, mayDecide, RENEW_EVERY } from "./lease_keeper";

const held = (person: string, mine: boolean): LeaseState => {
  const holder = { person, mine, since: "2025-06-01T12:00:00Z" };
  return { holder, expires_at: "2025-06-01T12:01:00Z", present: [holder] };
};

function keeperOf(renew: (takeOver: boolean) => Promise<LeaseState>) {
  const log: string[] = [];
  let tick: () => void = () => undefined;
  const keeper = new LeaseKeeper({
    renew,
    drop: () => log.push("dropped"),
    every: (milliseconds, act) => {
      expect(milliseconds).toBe(RENEW_EVERY);
      tick = act;
      return () => {
        tick = () => undefined;
      };
    },
  });
  return { keeper, log, tick: () => tick() };
}

const turn = () => new Promise<void>((resolve) => setTimeout(resolve));

describe("a lease keeper", () => {
  it("renews at once and at each turn, and drops the lease when it stops", async () => {
    let asked = 0;
    const { keeper, log, tick } = keeperOf(async () => {
      asked += 1;
      return held("Mara", true);
    });
    expect(mayDecide(keeper.getState())).toBe(true);
    keeper.start();
    keeper.start();
    await turn();
    tick();
    await turn();
    expect(asked).toBe(2);
    expect(keeper.getState()?.holder?.person).toBe("Mara");
    keeper.stop();
    keeper.stop();
    tick();
    expect(asked).toBe(2);
    expect(log).toEqual(["dropped"]);
  });

  it("says nothing as long as nobody else comes", async () => {
    const answers = [held("Mara", true), held("Mara", true), held("Jon", false)];
    const { keeper, tick } = keeperOf(async () => answers.shift() ?? held("Jon", false));
    let heard = 0;
    keeper.subscribe(() => {
      heard += 1;
    });
    keeper.start();
    await turn();
    tick();
    await turn();
    expect(heard).toBe(1);
    tick();
    await turn();
    expect(heard).toBe(2);
  });

  it("waits for another person, or takes the image over", async () => {
    const { keeper } = keeperOf(async (takeOver) => (takeOver ? held("Jon", true) : held("Mara", false)));
    keeper.start();
    await turn();
    expect(mayDecide(keeper.getState())).toBe(false);
    await keeper.takeOver();
    expect(mayDecide(keeper.getState())).toBe(true);
  });

  it("keeps what it knows while the server is away", async () => {
    let away = false;
    const { keeper, tick } = keeperOf(async () => {
      if (away) throw new Error("away");
      return held("Mara", false);
    });
    keeper.start();
    await turn();
    away = true;
    tick();
    await turn();
    expect(mayDecide(keeper.getState())).toBe(false);
  });

  it("lets no earlier answer undo a later one", async () => {
    const answers: ((state: LeaseState) => void)[] = [];
    const { keeper } = keeperOf(() => new Promise((resolve) => answers.push(resolve)));
    keeper.start();
    const taken = keeper.takeOver();
    answers[1]?.(held("Jon", true));
    await taken;
    answers[0]?.(held("Mara", false));
    await turn();
    expect(keeper.getState()?.holder?.person).toBe("Jon");
  });
});
