import * as all from "cannon-es";
import { readFileSync, writeFileSync } from "node:fs";

const CANNON = all.World ? all : all.default;
for (const each of JSON.parse(readFileSync("cases.json"))) {
  const world = new CANNON.World();
  world.gravity.set(0, 0, each.gravity);
  const top = new CANNON.Body({ mass: each.mass, linearDamping: 0, angularDamping: 0 });
  const [w, x, y, z] = each.q;
  top.quaternion.set(x, y, z, w);
  top.position.set(...each.centre);
  top.velocity.set(...each.centre_velocity);
  top.angularVelocity.set(...each.world_rates);
  top.inertia.set(...each.moments);
  top.invInertia.set(...each.moments.map((moment) => 1 / moment));
  top.updateInertiaWorld(true);
  world.addBody(top);
  if (!each.free) {
    const [pivot, origin] = [new CANNON.Vec3(0, 0, -each.arm), new CANNON.Vec3(0, 0, 0)];
    const ground = new CANNON.Body({ mass: 0 });
    world.addBody(ground);
    world.addConstraint(new CANNON.PointToPointConstraint(top, pivot, ground, origin));
  }
  const rows = ["t,w,x,y,z"];
  for (const t of each.times) {
    for (let i = 0; i < each.steps; i++) world.step(each.step);
    const q = top.quaternion;
    rows.push([t, q.w, q.x, q.y, q.z].join());
  }
  writeFileSync(`joint.${each.name}.csv`, rows.join("\n") + "\n");
}
