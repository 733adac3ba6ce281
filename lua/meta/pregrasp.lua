---@meta pregrasp
-- The manual of `require "pregrasp"`, in LuaCATS: editors with lua-language-server complete and check
-- by it. A test holds every name here against what the program registers, both ways. The options of the
-- planner's stages (GraphOptions, OptimizeOptions, ..) are the table of settings': the build writes them to
-- build/release/lua/options.lua (`pregrasp info --annotations`).
--
-- Units are SI and radians: points and lengths in m, times in s, forces in N, angles in rad. A name ending in _mm or _deg
-- says otherwise, one ending in _N or _J only says so. Scores, costs and their terms, weights and shares have no unit; nhat is
-- of unit length. A point {x, y, z} is in the frame that its name ends in: p_OC is the contact C in the object's frame O, p_W
-- is in the world. Quaternions are {w, x, y, z}. Reading or setting a name that is not here is an error.

---@alias Vector3 number[] {x, y, z}
---@alias FingerName "thumb"|"index"|"middle"|"ring"|"little"

---What a picture shows beside the bodies: overlay = {"forces", "cones"} shows these alone.
---@alias Overlay
---| "forces" # arrows of the fingers' forces and of the object's weight, with newtons
---| "cones" # friction cones at the fingers
---| "contacts" # where the object is supported
---| "trace" # normals and forces at all contact points
---| "ghost" # the object at its start, once it has left it
---| "fingers" # the fingers themselves
---| "axes" # the world frame's axes at its origin
---| "mesh" # planning: the contact mesh in place of the object
---| "scores" # planning: its colours, and the legend
---| "rollouts" # planning: where plans leave the object
---| "hand" # planning: the whole hand

---What break_when can wait for by name: break_when{"slip", "new_best"} stops at whichever comes first.
---@alias Condition
---| "contact_made" # physics: two bodies, or a fingertip and the object, begin to touch
---| "contact_lost" # physics: they no longer do
---| "slip" # physics: the friction of a fingertip that stuck comes to its limit
---| "penetration" # physics: two bodies overlap by more than 0.1 mm
---| "new_best" # an iteration found a cheaper plan than all before
---| "score_drop" # the end of the best plan scores less than that of the one before
---| "path_switched" # the search goes on with another path
---| "search_ended" # a path's iterations are done: by want of progress, or at their limit
---| "certified" # a plan is certified
---| "certify_failed" # a plan is not, and why
---| "ik_failed" # no hand pose was found for a grasp whose forces are fine, or for a frame
---| "grasp_found" # a grasp is feasible
---| "lifted" # a lift is held
---| "lift_failed" # a lift is not held, and why
---| "loosened" # a keyframe or frame gave up a demand

---@class pregrasp
---@field version string the program's version
---@field seed integer of everything random: --seed
local pregrasp = {}

---Opens a scene: a file (looked for in the working directory, beside the script, then among the program's own),
---what scene{..} gave, or its table.
---@param scene string|Scene|SceneTable
---@param options? OpenOptions
---@return Session
function pregrasp.open(scene, options) end

---@class OpenOptions
---@field seed? integer the script's --seed by default
---@field threads? integer cannot change a result; 0 is one per processor, at most 256
---@field set? table<string, number|string|Vector3> changes values: { ["object.mass"] = 0.2 }

---What there is to say of a scene before anything is planned: overlaps, what does not rest, sizes that look like another
---unit, departures from the rules. Also of one that open() refuses.
---@param scene string|Scene|SceneTable
---@return Check
function pregrasp.check(scene) end

---@class Check printed, its text
---@field text string
---@field clean boolean nothing but notes
---@field findings Finding[]

---@class Finding
---@field severity "note"|"warning"|"error"
---@field where string file and line of the body it is about
---@field text string

---How two objects and what led to each differ: two forks, two sessions, the same in another scene.
---@param a Session|Graph|Path|Optimizer|Trajectory|Grasps|Grasp|Motion|Frame|Simulation|Plan
---@param b Session|Graph|Path|Optimizer|Trajectory|Grasps|Grasp|Motion|Frame|Simulation|Plan
---@return Comparison
function pregrasp.compare(a, b) end

---@class Comparison printed, its text
---@field text string
---@field verdict "same"|"differ"|"one_goes_on"
---@field scene Difference? the first thing that differs between two sessions' scenes, shapes left aside
---@field common string? id of the last step that both have, or that says the same
---@field a string? id of the first step that differs; nil where that branch has ended
---@field b string?
---@field command Difference? what was asked for there: an option, or a setting by its full name
---@field first Difference? the first thing that came of it and differs
---@field same_noise boolean? both iterations draw the same noise: the same seed, path and iteration
---@field settings Difference[] that differ at the two ends, by full name
---@field scores ScoreChange[]? of two sessions' graphs of as many nodes: the ten nodes whose s_c differs most

---@class Difference
---@field field string
---@field a string as the log has it
---@field b string

---@class ScoreChange
---@field id integer
---@field thumb integer triangle
---@field index integer triangle
---@field a number s_c of the one
---@field b number and of the other
---@field change number b - a

---Goes on from a finished run, of save_state, save or `pregrasp run`: all its steps are there under their ids. Nothing is
---computed before a step is acted on, or asked for more than the log has; that is then held against the log.
---@param dir string
---@return Session # and the object at the step where it stood
function pregrasp.load_state(dir) end

---A study of many scenes and seeds, as `pregrasp eval`: makes the items that are missing in its folder, and the tables there.
---Cut off, the same call goes on. What departs from the project's rules is refused.
---@param options EvalOptions
---@return table[] # the items in their order, as the study's JSON has them, null as nil: of table1 a row each scene and seed
function pregrasp.eval(options) end

---@class EvalOptions
---@field dir string "out/.."
---@field study? "table1"|"ladder"|"learning"|"ik-order" "table1"
---@field scenes? (string|Scene|SceneTable)[] one or more; of ladder and learning the files of ladders, of ik-order none
---@field seeds? integer of each scene or ladder, or in all, 3
---@field first_seed? integer 1
---@field paths? integer to optimise at most, 10
---@field set? table<string, number|string|boolean|Vector3> changes values of every scene, and the planner's: { ["fingertips.friction"] = 0.5 }
---@field threads? integer of each item; cannot change a result
---@field keep_runs? boolean each item's run directory in DIR/runs; false

---A finished run, read back. What its files say is given as it is there; whether it is true is for `pregrasp verify` to say.
---@param dir string a run directory
---@return Run
function pregrasp.load(dir) end

---@class Run
---@field ids string[] of its steps, in the order of doing
---@field summary table summary.json: its fields by name, null as nil
---@field manifest table manifest.json
local Run = {}

---A step as steps.jsonl has it: fields by the names in app/recording/README.md, lists from 1, null as nil.
---@param id string "path.1.mppi.3"
---@return table
function Run:step(id) end

---A picture of a step, made anew.
---@param id string "path.1.mppi.3"
---@param options ShotOptions with `file`
function Run:shot(id, options) end

---Steps side by side, all by one camera, each with what it says: those of the list, before and after or more; the key steps without one.
---@param options RunStripOptions
function Run:strip(options) end

---@class RunStripOptions the list's entries are ids
---@field file string "out/..": a PNG
---@field against? Run a second run, shown below the first from where they first differ to what they came to; with a list its steps
---@field camera? CameraTable one that has all in sight
---@field size? integer[] {1920, 1440} pixels of the whole, the height at most
---@field quality? "draft"|"normal"|"still" "still"
---@field overlay? Overlay[] as of a run's own pictures
---@field legend? boolean true: what colours mean
---@field font_scale? number 1: size of all type, 0.3 to 4

-- Scenes. In a scene file these functions are globals. ---------------------------------------------

---A scene. A scene file ends with `return scene { .. }`.
---@param table SceneTable
---@return Scene
function pregrasp.scene(table) end

---A box with full edge lengths, centred: box{0.1, 0.2, 0.3} or box{x = 0.1, y = 0.2, z = 0.3}.
---@param size BoxTable|number[]
---@return Shape
function pregrasp.box(size) end

---A cylinder about z, centred: cylinder{r, h} or cylinder{r = .., h = ..}.
---@param size CylinderTable|number[]
---@return Shape
function pregrasp.cylinder(size) end

---A capsule about z, centred; h is the cylindrical part's, without the caps.
---@param size CylinderTable|number[]
---@return Shape
function pregrasp.capsule(size) end

---A sphere about its centre: sphere{r} or sphere{r = ..}.
---@param size SphereTable|number[]
---@return Shape
function pregrasp.sphere(size) end

---A closed triangle mesh, or the union of several in one file: mesh{"cup.stl", scale = 0.001}. Looked for beside the
---scene first.
---@param file MeshFileTable
---@return Shape
function pregrasp.mesh(file) end

---A closed surface given by 100 points or more in a PLY file, with normals or without: cloud{"cup.ply"}.
---They become a mesh; walls must be thicker than the points are apart.
---@param file FileTable
---@return Shape
function pregrasp.cloud(file) end

---Shapes in one body: union{ box{..}, { shape = sphere{..}, p = {..}, rpy_deg = {..} } }.
---@param parts (Shape|PlacedShapeTable)[]
---@return Shape
function pregrasp.union(parts) end

---@class SceneTable
---@field name string letters, digits, _ and -
---@field object BodyTable what is to be grasped; has a mass
---@field environment BodyTable[] what is around it, at least one body
---@field fingertips? FingertipsTable
---@field hand? string a hand's name or its hand.lua (docs/your_own_hand.md); shadow_right
---@field gravity? Vector3 {0, 0, -9.81} [m/s^2]
---@field camera? CameraTable pictures are framed automatically without

---@class BodyTable
---@field name? string "object", or "body1", "body2", .. in the environment
---@field shape Shape
---@field p? Vector3 where the shape's frame is [m]; {0, 0, 0}
---@field rpy_deg? Vector3 roll, pitch, yaw about the fixed axes: R = Rz Ry Rx
---@field mass? number [kg]; a body moves if and only if it has one
---@field friction? number 0.4; a pair of bodies uses the smaller
---@field com? Vector3 centre of mass in the body's frame [m]; uniform density without
---@field inertia? number[] {Ixx, Iyy, Izz} or with Ixy, Ixz, Iyz, about the centre of mass [kg m^2]

---@class FingertipsTable
---@field friction? number 0.8, between a fingertip and any body
---@field max_force? number largest force of a finger [N], 12
---@field stiffness? number of a finger's spring while pushing [N/m], 50
---@field damping? number 0.7, a multiple of sqrt(stiffness * object's mass)
---@field grasp_stiffness? number while a grasp closes and lifts [N/m], 300

---@class CameraTable
---@field p Vector3 where it stands [m]
---@field look_at Vector3 [m]
---@field fov_deg? number vertical field of view; 35

---@class PlacedShapeTable
---@field shape Shape
---@field p? Vector3 [m]
---@field rpy_deg? Vector3

---@class BoxTable
---@field x number [m]
---@field y number [m]
---@field z number [m]

---@class CylinderTable
---@field r number [m]
---@field h number [m]

---@class SphereTable
---@field r number [m]

---@class FileTable the file's name is the first entry
---@field scale? number 1; 0.001 for a file in millimetres

---@class MeshFileTable the file's name is the first entry
---@field scale? number 1; 0.001 for a file in millimetres
---@field repair? boolean drop faces given twice, merge corners that lie beside each other, close tiny holes; false

---@class Shape

---@class Scene

-- A session: one scene under work. ------------------------------------------------------------------

---@class Session
---@field name string the scene's
---@field file string the scene's file, "" for one built in a script
---@field seed integer
---@field dt number the physics step [s]
---@field step_id string of the last step, as in the log and on its picture
---@field bodies string[] names, the object's first
---@field object Body where the object starts
---@field departures string[] from the project's physical rules, a sentence each; empty is within them
---@field ids string[] of all steps, in the order of doing
---@field stopped Stop? where break_when last said yes
local Session = {}

---Whether the object can be grasped where it stands, by faces, edges or corners: by proof, else by generated grasps
---and a search.
---@return Verdict
function Session:verdict() end

---@class Verdict
---@field verdict string "certified", "searched" or "graspable"
---@field mu number the fingertips' friction
---@field mu_star? number mu*, the friction above which the proof fails; nil if it holds at 3, the largest tried
---@field thin boolean mu* lies within 0.05 of mu
---@field sentence string
---@field step_id string

---What pregrasp.check says of its scene.
---@return Check
function Session:check() end

---Lets the scene alone; from then on it starts where that ended.
---@param options? SettleOptions
---@return SettleResult
function Session:settle(options) end

---@class SettleOptions
---@field seconds? number [s], 1

---@class SettleResult
---@field moved_mm number the furthest that a centre of mass was from its start
---@field rotated_deg number the most that a body turned
---@field at_rest boolean under 1 mm and 0.5 deg
---@field body string that moved furthest
---@field not_converged integer physics steps whose contact forces were not found to the solver's tolerance
---@field unresolved_mm number how far bodies may have sunk into each other in these

---A simulation from the start, to be stepped by hand.
---@param options? SimulateOptions
---@return Simulation
function Session:simulate(options) end

---@class SimulateOptions
---@field trace? boolean every step tells its energies too: in `trace`, log and pictures, all in trace.jsonl; false

---From now on every step goes to a run directory: its log pair, and pictures of the start and of each
---shot{} ("key"), of every step ("all"), or none. It is finished by save(), or at the script's end:
---then pictures without a camera are drawn (those of shot{} once more), all by one that shows what each of them has to.
---@param options RecordOptions
function Session:record(options) end

---@class RecordOptions
---@field dir string "out/..", which is the folder of --out
---@field pictures? "none"|"key"|"all" "key"

---From now on the function sees the events of every physics step of the session's simulations and certificates, and of every
---step of the planner: it is asked after each action, in the order of its steps. Where it first says yes, a simulation's
---action ended there, and what takes several steps (run, next_stage) stops there; `stopped` says where. In place of a
---function, names of conditions, any of which will do. nil takes it back.
---@param predicate? Condition|Condition[]|(fun(event: Event): boolean?)
function Session:break_when(predicate) end

---@class Stop
---@field by string the condition that held, or "function"
---@field step_id string of the planner's step; "" of a simulation's physics step
---@field t number [s]
---@field num_steps integer physics steps, of a simulation or a certificate
---@field text string what was so; "" for a function

---What happened in one physics step: a "step" each, a "contact" for each contact point, a "finger" for each finger
---that is on. Fields of the other kinds are nil.
---@class Event
---@field kind string "step", "contact" or "finger"; of a planner's step its verb: "score", "prune", "path", "screen", "iterate", "certify", "grasp", "lift", "keyframe", ..
---@field t number after the step [s]
---@field num_steps integer? since the simulation's start
---@field speed number? step: of the object [m/s]
---@field a string? contact: a body's name
---@field b string? contact: the other's
---@field p_W Vector3? contact [m]
---@field penetration number? contact: overlap before the step [m], 0 without
---@field force_N number? contact, finger [N]
---@field slip_speed number? contact: [m/s]
---@field finger FingerName? finger
---@field touching boolean? finger
---@field slipping boolean? finger
---@field slip_mm number? finger: since it was put on
---@field step_id string? of a planner's step
---@field path integer? that it belongs to, by rank
---@field cost number? iterate: the best one so far
---@field text string? what happened, as its picture says

---A picture of the last step. It belongs to the run directory, unless it names a file.
---@param options? ShotOptions
function Session:shot(options) end

---@class ShotOptions the first entry, if there is one, is the picture's title
---@field caption? string in place of what happened and why
---@field camera? CameraTable else, in a run directory, one that its pictures share; in a file the picture's own
---@field size? integer[] {1280, 720} pixels
---@field quality? "draft"|"normal"|"still" "still"
---@field overlay? Overlay[] all of them
---@field card? boolean true: title and sentences, at the upper left
---@field legend? boolean true: what colours mean
---@field footer? boolean true: the line at the bottom
---@field font_scale? number 1: size of all type, 0.3 to 4
---@field file? string "out/NAME.png": drawn now, outside of the run directory

---Steps side by side, all by one camera, each with what it says: those of the list, before and after or more; the key steps so far without one, with `against` the last.
---@param options StripOptions
function Session:strip(options) end

---@class StripOptions the list's entries are ids of the session's steps, or objects that a session gave
---@field file string "out/..": a PNG
---@field against? Session|Graph|Path|Optimizer|Trajectory|Grasps|Grasp|Motion|Frame|Simulation|Plan another branch: what led to the list's one entry stands above what led to this, from the last step that both have and the first that differ to what they came to
---@field camera? CameraTable one that has all in sight
---@field size? integer[] {1920, 1440} pixels of the whole, the height at most
---@field quality? "draft"|"normal"|"still" "still"
---@field overlay? Overlay[] as of a run's own pictures
---@field legend? boolean true: what colours mean
---@field font_scale? number 1: size of all type, 0.3 to 4

---Writes the run directory with all steps so far: at `dir`, or the one that is recorded to.
---@param dir? string "out/.."
---@return string where
function Session:save(dir) end

---Writes a run directory with all steps so far, without pictures, that load_state goes on from in any process. Recording goes on.
---@param dir string "out/.."
---@param at? Graph|Path|Optimizer|Trajectory|Grasps|Grasp|Motion|Frame|Simulation|Plan where it stands; at the last step without
---@return string where
function Session:save_state(dir, at) end

---The object that goes on from a step: a Graph, Path, Optimizer, Trajectory, Grasp, Motion, Frame or Simulation; of the
---start the session itself.
---@param id string "path.1.mppi.3"
---@return Session|Graph|Path|Optimizer|Trajectory|Grasp|Motion|Frame|Simulation
function Session:go(id) end

---A step as the log has it: fields by the names in app/recording/README.md.
---@param id string
---@return table
function Session:step(id) end

---How far it came, and what the step that came furthest says.
---@return Explanation
function Session:why() end

---Why the step that came furthest is not of another path: how far that one came, beside it.
---@param path integer its rank
---@return Explanation
function Session:why_not(path) end

---The same scene with some values changed, as a session of its own at its start; this one is left as it is.
---@param options WhatIfOptions
---@return Session
function Session:what_if(options) end

---@class WhatIfOptions
---@field set table<string, number|string|boolean|Vector3> { ["object.p"] = {..}, ["environment.table.p"] = {..}, ["mppi.sigma"] = 0.5 }; as --set

---The whole run, as `pregrasp run` does it, to be taken step by step.
---@param options? RunOptions
---@return Plan
function Session:plan(options) end

---@class RunOptions
---@field paths? integer to optimise at most; 10
---@field all? boolean goes on after the first success; false
---@field plans? integer of a path that are certified at most; 4
---@field motions? integer hand motions tried of a path; 6
---@field set? table<string, number|string|boolean> settings of the planner by full name, from the graph on

---A whole run. Each step is one of the log's; any number of them can be taken back and again.
---@class Plan
---@field num_steps integer taken
---@field step_id string of the last one; "" before the first
---@field stage string what it is at
---@field finished boolean
---@field status string? nil before its end; as in summary.json
---@field end_id string? the step that the result is of
---@field reasons string[] at its end, a sentence for each path that was tried
local Plan = {}

---Takes steps.
---@param steps? integer 1
---@return boolean # false when it has ended
function Plan:step(steps) end

---Takes steps to the end, to a step, or to where break_when says yes; goes to a step that was taken, also back.
---@param to? string the id of a step
---@return boolean # true when break_when stopped it
function Plan:run(to) end

---Takes steps until one belongs to another stage of the pipeline: graph, trajectory, grasp, motion.
---@return boolean # true when break_when stopped it
function Plan:next_stage() end

---Takes steps back.
---@param steps? integer 1
function Plan:back(steps) end

---Takes steps again that were taken back.
---@param steps? integer 1
function Plan:forward(steps) end

---What its last step gave, as Session:go: to look at, or to go another way from.
---@return Session|Graph|Path|Optimizer|Trajectory|Grasp|Motion|Frame
function Plan:object() end

---Why it ended as it did, or where it is.
---@return Explanation
function Plan:why() end

---Why its result is not of another path: how far that one came, beside the end. Of a run that has ended.
---@param path integer its rank
---@return Explanation
function Plan:why_not(path) end

---As Session:save, with the summary of the run's result.
---@param dir? string "out/.."
---@return string where
function Plan:save(dir) end

---Why something came out as it did, from the decision's own numbers. Printed, its text.
---@class Explanation
---@field text string a sentence
---@field verdict string a word
---@field items ExplanationItem[] the numbers

---@class ExplanationItem
---@field name string
---@field value number?
---@field other number? what it is compared with: the text says what that is
---@field limit number? that it had to keep
---@field unit string of these numbers, as "mm"; "" for none
---@field met boolean? whether it did

---A body at the start.
---@param name string
---@return Body
function Session:body(name) end

---@class Body
---@field name string
---@field movable boolean
---@field p Vector3 origin of its frame in the world [m]
---@field q number[] {w, x, y, z}
---@field rpy_deg Vector3 roll, pitch, yaw about the fixed axes
---@field v Vector3 velocity of the origin [m/s]
---@field w Vector3 angular velocity [rad/s]

---Points spread over the object's surface, in its frame.
---@param options? CloudOptions
---@return Cloud
function Session:cloud(options) end

---@class CloudOptions
---@field points? integer 512; at most 4096

---@class Cloud
---@field count integer
---@field points Array|Vector3[] [m]
---@field normals Array|Vector3[] outward, unit length

---A big list that is not copied: a[1] to a[#a], nil beyond, ipairs(a) and pairs(a). It can only be read, and what a[i] gives
---is made anew each time: of a row of numbers another Array. A call that takes a list takes it too.
---@class Array
---@field count integer #a
local Array = {}

---Its items as a plain table, a copy: to change, to sort, for table.concat and table.unpack.
---@return table
function Array:table() end

---Signed distance from a world point to everything around the object.
---@param point Vector3
---@return Distance
function Session:distance(point) end

---@class Distance
---@field phi number [m], negative inside
---@field nhat Vector3 its unit gradient

---The contact mesh: the triangles that contacts are planned on, in the object's frame.
---@param options? MeshOptions
---@return Mesh
function Session:mesh(options) end

---@class MeshOptions
---@field triangles? integer 40; even, 12 to 200

---@class Mesh
---@field num_vertices integer
---@field num_triangles integer
---@field vertices Array|Vector3[] [m]
---@field triangles Array|integer[][] three vertices each, from 1, counter-clockwise from outside
---@field normals Array|Vector3[] of the triangles, outward
---@field areas Array|number[] [m^2]
---@field centres Array|Vector3[] [m]
---@field neighbors Array|integer[][] triangles that share an edge, from 1

---The contact graph, meshed: the first of the planner's stages. Its settings hold for the later ones.
---@param options? GraphOptions
---@return Graph
function Session:graph(options) end

-- The planner, stage by stage. Each object is a stepper: what it was before each step is kept, and back()
-- goes there exactly. A step has an id, which is on its picture, in the log and here. Numbers of nodes
-- and triangles are those of pictures and log, from 0: triangle t is mesh.triangles[t + 1].

---@class Graph
---@field stage "meshed"|"scored"|"pruned_context"|"pruned_free"|"connected" how far it is: context is cut by s_c, free by s_n
---@field step_id string
---@field num_triangles integer
---@field num_nodes integer ordered pairs of triangles: thumb, index
---@field num_edges integer 0 before it is connected
---@field top_percent number how many of the nodes each score keeps
---@field nodes Array|ContactState[] all of them with their scores: node id is nodes[id + 1]
---@field initial integer[] ids of the nodes that a path may begin with
---@field kept integer[] ids of all kept nodes
---@field mesh Mesh
local Graph = {}

---Scores every node: s_c among the surroundings at the start, s_n without them.
function Graph:score() end

---The pruning steps that are still to do.
---@param options? PruneOptions
function Graph:prune(options) end

---One of three steps: the best by s_c stay, the best by s_n stay, edges are built.
---@param nodes? integer at most so many nodes of it: prune_step(1) is a node at a time
---@return boolean # false when there is none left
function Graph:prune_step(nodes) end

---Why a node is there: a sentence when printed, and the numbers that decided.
---@param id integer|NodeKey
---@return Reason
function Graph:why(id) end

---The same, for a node that is not there.
---@param id integer|NodeKey
---@return Reason
function Graph:why_not(id) end

---One node: node(17), or node{ thumb = 0, index = 17 }.
---@param id integer|NodeKey
---@return ContactState
function Graph:node(id) end

---@class NodeKey a node by its triangles
---@field thumb integer
---@field index integer

---Which triangles a finger prefers: those with the best node first.
---@param options? TrianglesOptions
---@return TriangleScore[]
function Graph:triangles(options) end

---@class TrianglesOptions
---@field finger? "thumb"|"index" "thumb"
---@field count? integer 10

---@class TriangleScore
---@field triangle integer
---@field finger FingerName
---@field best number the highest s_c of a node with the finger there
---@field mean number of all such nodes
---@field node integer the id of the best one
---@field kept integer how many such nodes the graph keeps
---@field fits boolean the fingertip can be somewhere on it at the start
---@field p_OCentre Vector3 [m]
---@field nhat_O Vector3 outward normal
---@field area number [m^2]

---The best nodes by s_c.
---@param count? integer 10
---@return ContactState[]
function Graph:top(count) end

---Kept nodes that share a triangle with a kept node, itself included.
---@param id integer
---@return integer[] ids
function Graph:neighbors(id) end

---All paths of contact states, best first, each found when it is asked for.
---@param options? PathsOptions
---@return Paths
function Graph:paths(options) end

---A path put together by hand from nodes, kept or not; it is a step "paths.hand", and no run that takes it is within the rules.
---@param nodes (integer|NodeKey)[]
---@return Path
function Graph:path(nodes) end

---The same graph, as far as it is, in another scene, as pregrasp.compare takes it; this one is left as it is.
---@param options WhatIfOptions
---@return Graph
function Graph:what_if(options) end

---Takes steps again that back() took back.
---@param steps? integer 1
function Graph:forward(steps) end

---Takes steps back.
---@param steps? integer 1
function Graph:back(steps) end

---A copy with the same past.
---@return Graph
function Graph:fork() end

---A picture of its last step.
---@param options? ShotOptions
function Graph:shot(options) end

---A node of the graph: the thumb somewhere on one triangle, the index finger on another, or the same.
---@class ContactState
---@field id integer
---@field thumb integer triangle
---@field index integer triangle
---@field s_c number score among the surroundings, mean of its placements, 0 to 1
---@field s_n number score without surroundings
---@field rank_c integer 1 is the best by s_c; of equal ones by s_n, then by id
---@field rank_n integer 1 is the best by s_n; of equal ones by s_c, then by id
---@field occluded number share of its contacts where no fingertip can be
---@field thumb_fits boolean the thumb's tip can be somewhere on its triangle at the start
---@field index_fits boolean likewise
---@field initial boolean may begin a path
---@field kept boolean

---@class Reason
---@field text string the sentence
---@field verdict "not_scored"|"scored"|"kept_by_context"|"kept_by_free"|"kept_by_both"|"pruned" context is s_c, free is s_n
---@field kept boolean
---@field id integer
---@field node ContactState
---@field threshold_c number the lowest s_c among the top percent by it
---@field threshold_n number the lowest s_n among the top percent by it
---@field num_nodes integer
---@field num_kept_each integer how many the top percent are

---Paths by rank: paths[1] is the best; nil beyond the last.
---@class Paths
---@field count number how many there are, with those that a filter passes over
---@field stages integer
---@field order "explore"|"paper"
local Paths = {}

---The best path that next() has not given yet; nil after the last.
---@return Path?
function Paths:next() end

---The best `count` paths; next() is not changed.
---@param count integer
---@return Path[]
function Paths:top(count) end

---Why a path has its rank, and which it beat.
---@param rank integer
---@return Explanation
function Paths:why(rank) end

---@class Path
---@field rank integer 1 is the best; 0 of one that was put together by hand
---@field score number s_c of the first node and s_n of the others
---@field value number what the order goes by: in "explore" the first node's s_c as a share of the best, over 1 + repeats; in "paper" the score
---@field repeats number how often paths before it had what it has: each finger's triangle, half each finger's side; 0 in "paper"
---@field terms number[] its summands
---@field nodes ContactState[]
---@field siblings Sibling[] the best five of the paths that it beat by its last node
---@field step_id string "" before next() or shot{} recorded it
local Path = {}

---Starts the optimisation of a trajectory along the path (MPPI). Nothing is done before step().
---@param options? OptimizeOptions
---@return Optimizer
function Path:optimize(options) end

---Why it has its rank, and which it beat.
---@return Explanation
function Path:why() end

---Why it is not before another.
---@param other Path
---@return Explanation
function Path:why_not(other) end

---A picture of the path on the contact mesh.
---@param options? ShotOptions
function Path:shot(options) end

---@class Sibling
---@field nodes integer[] ids
---@field score number
---@field behind number by how much it lost

---@class Optimizer
---@field iteration integer iterations done
---@field best_cost number? of all iterations; nil before the first
---@field mean_cost number? of the last iteration's rollouts
---@field score_scale number? how far the first iteration's scores are apart: what tie-breaking terms are weighed by
---@field best CostTerms of the best plan so far
---@field nominal RolloutStage[]? the mean that the next iteration's noise is about, as a plan; nil before the first
---@field plans PlanChoice[] those kept because their ends differ, the best first: what certify(options, plan) numbers
---@field sigma number standard deviation of the next iteration's noise, in the plan's own scales: no unit
---@field settings table<string, number|string|boolean> of the next iteration, as OptimizeOptions
---@field converged boolean it ended for want of progress, not at the limit of iterations
---@field best_history number[] best_cost after each iteration
---@field mean_history number[] mean_cost after each iteration
---@field path_rank integer
---@field step_id string
local Optimizer = {}

---One iteration.
---@return boolean # false, and nothing done, when it has ended
function Optimizer:step() end

---Iterations until it ends, break_when says yes, or so many are done.
---@param count? integer
---@return boolean # true when break_when stopped it
function Optimizer:run(count) end

---Changes settings from the next iteration on: o:set{ sigma = 0.3 }.
---@param options OptimizeOptions
function Optimizer:set(options) end

---The plan of a rollout of the last iteration takes the mean's place in the next one; 0 takes that back.
---@param number integer
function Optimizer:set_nominal(number) end

---A few iterations that tell what the path is worth, before the first step(), which goes on from
---what they found.
---@param options? ScreenOptions
---@return Screening
function Optimizer:screen(options) end

---@class Screening
---@field round integer of screening this path, from 1
---@field iterations integer of this round
---@field rollouts integer
---@field value number of the best plan so far: its reward less what a certificate refuses
---@field rest_reward number of doing nothing
---@field score_scale number as Optimizer.score_scale
---@field best CostTerms of the best plan so far
---@field step_id string

---Takes iterations back.
---@param steps? integer 1
function Optimizer:back(steps) end

---Takes iterations again that back() took back.
---@param steps? integer 1
function Optimizer:forward(steps) end

---A copy with the same past that goes on with other settings.
---@param options? OptimizeOptions
---@return Optimizer
function Optimizer:fork(options) end

---The plans of the last iteration. Where there was a best plan before it, the first is the mean, the second that plan.
---@return Array|Rollout[]
function Optimizer:rollouts() end

---The rollouts that weigh most in the new mean.
---@param count? integer 5
---@return Rollout[]
function Optimizer:elite(count) end

---A rollout of the last iteration with its plan: what each finger does in each stage.
---@param number integer
---@return Rollout
function Optimizer:rollout(number) end

---The whole trajectory of a rollout of the last iteration, simulated again; of the best plan so far without a number.
---@param number? integer
---@param every? integer physics steps from one row to the next; 10
---@return Array|TraceRow[]
function Optimizer:trace(number, every) end

---What made a rollout cost what it does: its terms beside the mean of all; of the cheapest one without a number.
---@param number? integer
---@return Explanation
function Optimizer:why(number) end

---Why a rollout is not another: the cheapest one without a second number.
---@param number integer
---@param other? integer
---@return Explanation
function Optimizer:why_not(number, other) end

---A plan simulated through the full Simbody model, and again at half the time step: one of those kept because their
---ends differ, 1 the best; or one made by hand, a list of stages: { { index = { p_OC = {..}, p_WTargets = { {..} } } }, .. }.
---Of a finger made by hand p_OC (not while it stays on from the stage before) and p_WTargets, one a knot or one for all,
---are needed; p_OC goes to the nearest place where a contact may lie. Trajectory.stages, changed or not, is such a list.
---@param options? CertifyOptions
---@param plan? integer|PlanStage[] 1
---@return Trajectory
function Optimizer:certify(options, plan) end

---A picture of the last iteration: where its best plans leave the object.
---@param options? ShotOptions
function Optimizer:shot(options) end

---A plan's cost: minus its reward, plus penalties that are zero for a plan that does nothing wrong.
---@class CostTerms
---@field total number the penalties less the reward: what a rollout is ranked by
---@field stage_scores number[] at the start of each stage
---@field final_score number how graspable the object is after the hold
---@field room number for grasps there: of contact sets that hold, those that the surroundings leave free
---@field reward number the sum of these, a stage's start counting at most as much as the end
---@field no_contact number penalty: no finger ever touches
---@field slip number tie-breaker: share of the contact time at the friction cone's limit
---@field effort number tie-breaker: mean force over the largest one allowed
---@field unrest number tie-breaker: speed when the hold ends
---@field speed number tie-breaker: peak speed of the object above 0.35 m/s
---@field tip_overlap number penalty: a fingertip is within the surroundings
---@field tip_spacing number penalty: two fingertips overlap
---@field hold number penalty: the object moves in the hold
---@field haste number penalty: a fingertip that touches is faster than a hand can be
---@field fragility number penalty: the plan ends elsewhere where friction and mass differ
---@field fall number penalty: the object falls out of the scene

---@class Rollout
---@field number integer
---@field cost number
---@field weight number in the new mean, by cost without fragility
---@field terms CostTerms
---@field X_WO Transform where the object ends
---@field stages RolloutStage[]? of rollout(number) alone

---@class RolloutStage
---@field thumb RolloutFinger
---@field index RolloutFinger

---@class RolloutFinger
---@field on boolean
---@field kept boolean it was on in the stage before, and keeps its contact
---@field triangle integer that it may touch; where it is kept, that of the stage before
---@field p_OC Vector3? contact point in the object's frame [m]; nil unless it is put on here
---@field nhat_O Vector3? outward normal there
---@field knots RolloutKnot[]

---@class RolloutKnot how far a finger's spring is deflected at the end of a knot
---@field depth number along the inward normal [m]
---@field tangent number[] along the contact's tangents [m]
---@field travel_W Vector3 further, in the world [m]

---@class PlanChoice
---@field number integer
---@field cost number
---@field terms CostTerms
---@field X_WO Transform where the object ends
---@field stages RolloutStage[]

---@class TraceRow
---@field t number [s]
---@field X_WO Transform of the object
---@field fingers TraceFinger[] those that are on

---@class TraceFinger
---@field finger FingerName
---@field touching boolean
---@field slipping boolean
---@field p_WF Vector3 the fingertip point [m]
---@field p_WTarget Vector3 where its spring pulls [m]
---@field f_W Vector3 force on the object [N]

---@class NeighbourMotion how far movable bodies other than the object are from where the scene has them
---@field worst? string the one that moved most, 30 deg counting as much as 5 cm; nil if there are none
---@field moved_mm number the most of all
---@field turned_deg number
---@field disturbed boolean one turned over 30 deg, or is over 5 cm lower: never a success

---@class Robustness the plan in five worlds with one change each: friction between bodies, mass, how supports resist turning
---@field worlds integer
---@field held integer of them, those in which it holds and ends within 20 mm and 10 deg of where it should
---@field worst_shift_mm number between the ends
---@field worst_turn_deg number
---@field elsewhere string[] the changes with which it does not hold or ends elsewhere

---@class Trajectory
---@field certified boolean
---@field reasons string[] why not; empty if it is
---@field slow number how many times as long as planned its stages and transfers take
---@field hold_shift_mm number how far the object moves in the hold
---@field hold_turn_deg number how far it turns
---@field step_shift_mm number between the final positions at the full and at half the time step
---@field step_turn_deg number between the final orientations
---@field max_penetration_mm number between bodies
---@field not_converged integer physics steps whose contact forces were not found to the solver's tolerance
---@field unresolved_mm number how far bodies may have sunk into each other in such steps, at the full or at half the time step
---@field max_tip_overlap_mm number of a fingertip with the surroundings
---@field max_speed number of the object [m/s]
---@field max_force_N number of a finger
---@field seconds number simulated [s]
---@field waits number[] before each stage, for the hand to bring its fingers to new contacts [s]
---@field out_of_reach_t number? when the hand was found to have no pose for the contacts [s]; nil if it has one, or the plan fails otherwise
---@field neighbours NeighbourMotion at its end
---@field robust Robustness? nil unless it is certified
---@field num_steps integer
---@field stays_when_released boolean under 10 mm and 5 deg in 1 s without fingers
---@field released_shift_mm number how far it moves in that second
---@field released_turn_deg number how far it turns
---@field pressing GraspContact[] that press at its end; every grasp keeps them unless the object stays without
---@field stages PlanStage[] what the fingers do
---@field object Body at its end
---@field step_id string
local Trajectory = {}

---Grasps at the trajectory's end, tested and, where feasible, lifted: generated ones, then those of a search. Where
---the search finds none, the generated ones are not refined.
---@param options? GraspsOptions
---@return Grasps
function Trajectory:grasps(options) end

---Why it is certified or not: its numbers beside the bounds.
---@return Explanation
function Trajectory:why() end

---Why it is not another plan's: the numbers of both certificates. "better" is certified, then held in more changed worlds.
---@param other Trajectory
---@return Explanation
function Trajectory:why_not(other) end

---The whole trajectory as it was certified, the hold included.
---@param every? integer physics steps from one row to the next; 10
---@return Array|TraceRow[]
function Trajectory:trace(every) end

---A body at its end.
---@param name string
---@return Body
function Trajectory:body(name) end

---A picture of its end.
---@param options? ShotOptions
function Trajectory:shot(options) end

---@class PlanStage
---@field thumb PlanFinger
---@field index PlanFinger

---@class PlanFinger
---@field on boolean
---@field kept boolean it was on in the stage before, and keeps its contact
---@field p_OC Vector3 contact point in the object's frame [m]
---@field nhat_O Vector3 outward normal there
---@field p_WTargets Vector3[] where its spring pulls at the end of each knot [m]

---@class GraspContact
---@field finger FingerName
---@field p_OC Vector3 in the object's frame [m]
---@field nhat_O Vector3 outward normal there

---The grasps by sample, then those that the search found: grasps[1] is the first; nil beyond the last.
---@class Grasps
---@field count integer
---@field num_feasible integer
---@field r_suc number share of the samples that is feasible, with refinement
---@field r_suc_raw number and without
---@field num_lifting integer of the feasible ones, those whose lift is held
---@field r_lift number share of the samples that is feasible and whose lift is held
local Grasps = {}

---For a loop: for i, grasp in grasps:all() do .. end.
---@return fun(): integer, Grasp
function Grasps:all() end

---The feasible grasp that comes first by, in turn: its lift is held, no neighbour is disturbed, pushes withstood,
---soft and stiff, it is the generator's, the forearm is free, the wrench's margin; nil without any.
---@return Grasp?
function Grasps:best() end

---How many failed, and why.
---@return Explanation
function Grasps:why() end

---@class Grasp
---@field feasible boolean
---@field reason string "feasible", or the first demand that is not met
---@field raw_reason string the same without refinement
---@field text string a sentence: which fingers, and what stands in the way
---@field sample integer among those of its source
---@field source "generator"|"search"
---@field fingers FingerName[]
---@field contacts GraspContact[]
---@field moved_mm number the farthest a contact was moved by refinement
---@field refinements integer sets tried
---@field wrench WrenchResult? forces in the object's frame; nil if they were not tested
---@field ik IkResult? nil if the forces failed already
---@field lift Lift? nil unless it is feasible
---@field step_id string
local Grasp = {}

---The hand motion that ends in this grasp. Nothing is solved before it is asked for.
---@param options? MotionOptions
---@return Motion
function Grasp:motion(options) end

---What stands in the way of it, or what its lift withstands.
---@return Explanation
function Grasp:why() end

---Why it is not another, of the same trajectory or not, its lift included: the first that differs of what best() goes by.
---@param other? Grasp the one that best() gives
---@return Explanation
function Grasp:why_not(other) end

---A picture of the hand in it.
---@param options? ShotOptions
function Grasp:shot(options) end

---@class Lift
---@field held boolean the object follows within 10 mm and 15 deg, and fingers alone hold it at the end
---@field reasons string[] why it is not held: "gives_way", "does_not_follow", ..; empty if it is
---@field text string a sentence: what it withstands, or what stands in the way
---@field height number how far it came along the way [m]
---@field shift_mm number the farthest it was from where it should be
---@field turn_deg number the most that it turned
---@field slip_mm number the farthest that a fingertip slid
---@field direction_W Vector3 of the way, unit length: nearest to up in which it can leave
---@field pushes integer of six pushes with half the weight at the top, those that it withstands
---@field soft boolean whether the lift holds with fingers of 150 N/m too
---@field stiff boolean and with 600 N/m
---@field forearm_free boolean whether the forearm, 20 cm behind the palm and 3 cm thick, is clear of all bodies at the grasp and at the end
---@field not_converged integer physics steps whose contact forces were not found to the solver's tolerance
---@field unresolved_mm number how far bodies may have sunk into each other in such steps; over 1 it is not held
---@field neighbours NeighbourMotion at its end
---@field step_id string

---@class Motion
---@field finished boolean
---@field num_keyframes integer
---@field num_solved integer of them
---@field num_frames integer few before free parts are given their time; then as many as there are
---@field order "reverse"|"forward"
---@field summary MotionSummary? nil before it is finished
---@field step_id string
local Motion = {}

---For a loop over keyframes in the order of solving, each solved when its turn comes.
---@return fun(): Frame
function Motion:keyframes() end

---For a loop over all frames in time; finishes the motion first.
---@return fun(): Frame
function Motion:frames() end

---Solves the next keyframe.
---@return boolean # false when all are solved
function Motion:step() end

---Keyframes that are left, in-betweens, smoothing.
function Motion:finish() end

---Takes keyframes back, or the finish.
---@param steps? integer 1
function Motion:back(steps) end

---Takes again what back() took back.
---@param steps? integer 1
function Motion:forward(steps) end

---What the last keyframe gave up, or what the finished motion came to.
---@return Explanation
function Motion:why() end

---Why it is not another motion, both finished.
---@param other Motion
---@return Explanation
function Motion:why_not(other) end

---A picture of the last step.
---@param options? ShotOptions
function Motion:shot(options) end

---@class MotionSummary
---@field frames integer
---@field failed integer frames without a pose, or with a way to them that goes through something
---@field blocked_ways integer of these, the latter
---@field loosened integer that gave something up
---@field max_tip_error_mm number
---@field min_clearance_mm number
---@field max_joint_speed number [rad/s]
---@field max_wrist_speed number [m/s]
---@field forearm_free boolean whether the forearm, 20 cm behind the palm and 3 cm thick, is clear of all bodies in every frame
---@field over_limits integer frames at which the hand exceeds a limit of speed or acceleration

---@class Frame
---@field number integer from 1, in time; of a keyframe, before free parts are given their time
---@field t number [s]
---@field simulated_t number of the row of rollout.csv, then of lift.csv, that it shows [s]
---@field phase string "approach", "contact", "transit" (between contact stages no finger touches), "closing" or "lift"
---@field loosened string what it gave up: "none", or the rung of the ladder
---@field failed boolean no pose, or a way to it that goes through something
---@field way_clear boolean the way from the frame before is free of overlap
---@field tip_error_mm number of the worst fingertip
---@field clearance_mm number
---@field X_WH Transform of the palm
---@field q HandJoints
---@field X_WO Transform of the object
---@field touching FingerName[]
---@field step_id string
local Frame = {}

---What it gave up, beside what was demanded.
---@return Explanation
function Frame:why() end

---Why it is not another: what each gave up, with the numbers of both.
---@param other Frame
---@return Explanation
function Frame:why_not(other) end

---A picture of it.
---@param options? ShotOptions
function Frame:shot(options) end

-- A simulation, stepped by hand. Each call that changes it is a step "sim.N" of the session's journal. --

---@class Simulation
---@field t number [s]
---@field num_steps integer physics steps since the start, which back() can take back
---@field step_id string of the action that led here
---@field object Body
---@field fingers Fingers
---@field contacts Contact[] of the last physics step
---@field trace StepTrace? of the last physics step; nil unless simulate{ trace = true }
local Simulation = {}

---Puts a finger on the object, at the surface point nearest to p_OC, without force yet.
---@param options TouchOptions
function Simulation:touch(options) end

---@class TouchOptions
---@field finger FingerName
---@field p_OC Vector3 in the object's frame [m]

---Moves where a finger's spring pulls, evenly over `seconds`: f = -k (p - p_target), within the
---friction cone and the force cap.
---@param options MoveOptions
---@return boolean # true when break_when stopped it
function Simulation:move(options) end

---@class MoveOptions
---@field finger FingerName
---@field by? Vector3 in the world, from where the target is [m]; either this
---@field to? Vector3 or this [m]
---@field seconds? number [s], 1

---Takes a finger off.
---@param options LiftOptions
function Simulation:lift(options) end

---@class LiftOptions
---@field finger FingerName

---Lets time pass with the targets where they are.
---@param options? WaitOptions
---@return boolean # true when break_when stopped it
function Simulation:wait(options) end

---@class WaitOptions
---@field seconds? number [s], 1

---Physics steps with the targets where they are.
---@param steps? integer 1
---@return boolean # true when break_when stopped it
function Simulation:step(steps) end

---Takes physics steps back, exactly.
---@param steps? integer 1
function Simulation:back(steps) end

---Takes physics steps again that back() took back.
---@param steps? integer 1
function Simulation:forward(steps) end

---The same actions in another scene, as a simulation of a session of its own.
---@param options WhatIfOptions
---@return Simulation
function Simulation:what_if(options) end

---A copy with the same past, which goes its own way from here.
---@return Simulation
function Simulation:fork() end

---A picture of the simulation as it is.
---@param options? ShotOptions
function Simulation:shot(options) end

---A body as it is now.
---@param name string
---@return Body
function Simulation:body(name) end

---@class Fingers
---@field thumb Finger
---@field index Finger
---@field middle Finger
---@field ring Finger
---@field little Finger

---@class Finger
---@field on boolean
---@field touching boolean pressed on the surface in the last step
---@field slipping boolean at the limit of friction in the last step
---@field force_N number on the object [N]
---@field normal_N number its part that presses
---@field friction_N number its part along the surface
---@field limit_N number what friction can give at this pressure
---@field slip_mm number slid over the surface since it was put on
---@field p_OC Vector3 contact point in the object's frame [m]
---@field nhat_O Vector3 outward normal there
---@field p_WF Vector3 the fingertip point [m]
---@field p_WTarget Vector3 where its spring pulls [m]
---@field f_W Vector3 force on the object [N]

---@class StepTrace
---@field max_penetration_mm number largest overlap before the step
---@field kinetic_J number of all movable bodies after the step
---@field potential_J number in the scene's gravity, 0 at the world's origin

---@class Contact
---@field a string a body's name
---@field b string the other's
---@field p_W Vector3 [m]
---@field nhat_W Vector3 from a to b
---@field f_W Vector3 force on b [N]
---@field force_N number
---@field gap_mm number before the step, negative when they overlap
---@field slip_speed number of b along a's surface [m/s]

-- The tests of a grasp. ------------------------------------------------------------------------------

---Whether contacts can hold an object: forces in the friction cones with zero net wrench exist, and forces
---that balance the weight. Torques are about the origin of p. Exact circular cones.
---@param options WrenchOptions
---@return WrenchResult
function pregrasp.wrench(options) end

---@class WrenchOptions
---@field p Vector3[] contact points [m]
---@field n Vector3[] normals into the object, any length
---@field mu? number 0.8
---@field mass? number of the object, its weight acting at the origin [kg], 0
---@field gravity? Vector3 [m/s^2], {0, 0, -9.81}
---@field f_min? number smallest normal force of every contact [N], 0.5
---@field f_max? number largest [N], 12
---@field torque_scale? number torques are divided by this length [m], 1: the object's radius

---@class WrenchResult
---@field feasible boolean
---@field closed boolean force closure: margin > 0
---@field margin number Ferrari and Canny's epsilon, signed
---@field min_normal number smallest normal part of the forces [N]
---@field forces Vector3[] on the object [N]: of least effort, or, if not feasible, those on which the proof ended
---@field status string "feasible", or the condition that fails
---@field residual number net wrench that these leave [N, torques over torque_scale]: rounding if feasible

---A hand pose whose fingertips touch the contacts, within cones of 60 deg, without overlap with
---the scene's bodies at the start, the object and the hand itself; certified by FCL.
---@param options IkOptions
---@return IkResult
function pregrasp.ik(options) end

---@class IkOptions
---@field contacts IkContacts of fingers that the hand has
---@field scene? Session without one only the hand itself is in the way
---@field hand? string without a scene: a hand's name or its hand.lua (docs/your_own_hand.md); the Shadow Hand
---@field seed? integer 1
---@field max_starts? integer initial postures tried, 20
---@field near? IkResult begin with this hand and stay near it: an answer for contacts a little further on

---@class IkContacts
---@field thumb? IkContact
---@field index? IkContact
---@field middle? IkContact
---@field ring? IkContact
---@field little? IkContact

---@class IkContact
---@field p Vector3 on the object's surface, in the world [m]
---@field n Vector3 the surface's normal there, into the object; with a scene either side will do

---@class IkResult
---@field status string "solved", or what is not met
---@field solved boolean
---@field X_WH Transform of the palm
---@field q HandJoints
---@field tip_error number of the worst fingertip [m]
---@field cone_angle number between a distal axis and its inward normal, the largest [rad]
---@field clearance number least distance but at the contacts [m]; 0.02 if nothing is closer
---@field starts integer initial postures tried
---@field method string whose solution it is

---@class Transform
---@field p Vector3 [m]
---@field q number[] {w, x, y, z}

---Joint angles by the hand's own names [rad]; here those of the Shadow Hand.
---@class HandJoints
---@field FFJ4 number
---@field FFJ3 number
---@field FFJ2 number
---@field FFJ1 number
---@field MFJ4 number
---@field MFJ3 number
---@field MFJ2 number
---@field MFJ1 number
---@field RFJ4 number
---@field RFJ3 number
---@field RFJ2 number
---@field RFJ1 number
---@field LFJ5 number
---@field LFJ4 number
---@field LFJ3 number
---@field LFJ2 number
---@field LFJ1 number
---@field THJ5 number
---@field THJ4 number
---@field THJ3 number
---@field THJ2 number
---@field THJ1 number

return pregrasp
