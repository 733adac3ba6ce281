---@meta pregrasp
-- The manual of `require "pregrasp"`, in LuaCATS: editors with lua-language-server complete and check
-- by it. A test holds every name here against what the program registers, both ways.
--
-- Units are SI and radians; a name ending in _mm, _deg or _N says otherwise. A point {x, y, z} is in
-- the frame that its name ends in: p_OC is the contact C in the object's frame O, p_W is in the world.
-- Quaternions are {w, x, y, z}. Reading or setting a name that is not here is an error.

---@alias Vector3 number[] {x, y, z}
---@alias FingerName "thumb"|"index"|"middle"|"ring"|"little"

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
---@field threads? integer cannot change a result; 0 is one per processor
---@field set? table<string, number|string|Vector3> changes values: { ["object.mass"] = 0.2 }

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

---@param size SphereTable|number[]
---@return Shape
function pregrasp.sphere(size) end

---A closed triangle mesh: mesh{"cup.stl", scale = 0.001}. Looked for beside the scene first.
---@param file FileTable
---@return Shape
function pregrasp.mesh(file) end

---A surface given by points only; it is reconstructed.
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
---@field max_force? number 12 N
---@field stiffness? number 50 N/m
---@field damping? number 0.7, a multiple of sqrt(stiffness * object's mass)

---@class CameraTable
---@field p Vector3 where it stands [m]
---@field look_at Vector3 [m]
---@field fov_deg? number vertical field of view; 35

---@class PlacedShapeTable
---@field shape Shape
---@field p? Vector3
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
local Session = {}

---Lets the scene alone; from then on it starts where that ended.
---@param options? SettleOptions
---@return SettleResult
function Session:settle(options) end

---@class SettleOptions
---@field seconds? number 1

---@class SettleResult
---@field moved_mm number the furthest that a centre of mass was from its start
---@field rotated_deg number
---@field at_rest boolean under 1 mm and 0.5 degrees
---@field body string that moved furthest

---A simulation from the start, to be stepped by hand.
---@return Simulation
function Session:simulate() end

---From now on every step goes to a run directory: its log pair, and pictures of the start and of each
---shot{} ("key"), of every step ("all"), or none. It is finished by save(), or at the script's end.
---@param options RecordOptions
function Session:record(options) end

---@class RecordOptions
---@field dir string "out/..", which is the folder of --out
---@field pictures? "none"|"key"|"all" "key"

---A picture of the last step. It belongs to the run directory, unless it names a file.
---@param options? ShotOptions
function Session:shot(options) end

---@class ShotOptions
---@field caption? string in place of what happened and why
---@field camera? CameraTable
---@field size? integer[] {1280, 720} pixels
---@field quality? "draft"|"normal"|"still" "still"
---@field overlay? ("forces"|"cones"|"contacts"|"ghost"|"fingers"|"axes")[] all of them
---@field file? string "out/..": drawn now, outside of the run directory

---Writes the run directory with all steps so far: at `dir`, or the one that is recorded to.
---@param dir? string "out/.."
---@return string where
function Session:save(dir) end

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
---@field points Vector3[] [m]
---@field normals Vector3[] outward, unit length

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
---@field vertices Vector3[] [m]
---@field triangles integer[][] three vertices each, from 1, counter-clockwise from outside

-- A simulation, stepped by hand. Each call that changes it is a step "sim.N" of the session's journal. --

---@class Simulation
---@field t number [s]
---@field num_steps integer physics steps since the start, which back() can take back
---@field step_id string of the action that led here
---@field object Body
---@field fingers Fingers
---@field contacts Contact[] of the last physics step
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
function Simulation:move(options) end

---@class MoveOptions
---@field finger FingerName
---@field by? Vector3 in the world, from where the target is [m]; either this
---@field to? Vector3 or this
---@field seconds? number 1

---Takes a finger off.
---@param options LiftOptions
function Simulation:lift(options) end

---@class LiftOptions
---@field finger FingerName

---Lets time pass with the targets where they are.
---@param options? WaitOptions
function Simulation:wait(options) end

---@class WaitOptions
---@field seconds? number 1

---Physics steps with the targets where they are.
---@param steps? integer 1
function Simulation:step(steps) end

---Takes physics steps back, exactly.
---@param steps? integer 1
function Simulation:back(steps) end

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
---@field force_N number on the object
---@field normal_N number its part that presses
---@field friction_N number its part along the surface
---@field limit_N number what friction can give at this pressure
---@field slip_mm number slid over the surface since it was put on
---@field p_OC Vector3 contact point in the object's frame
---@field nhat_O Vector3 outward normal there
---@field p_WF Vector3 the fingertip point
---@field p_WTarget Vector3 where its spring pulls
---@field f_W Vector3 force on the object [N]

---@class Contact
---@field a string a body's name
---@field b string the other's
---@field p_W Vector3
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
---@field forces Vector3[] on the object, of least effort [N]
---@field status string "feasible", or the condition that fails
---@field residual number net wrench that is left, 0 if feasible

---A hand pose whose fingertips touch the contacts, within cones of 60 degrees, without overlap with
---the scene's bodies at the start, the object and the hand itself; certified by FCL.
---@param options IkOptions
---@return IkResult
function pregrasp.ik(options) end

---@class IkOptions
---@field contacts IkContacts
---@field scene? Session without one only the hand itself is in the way
---@field seed? integer 1
---@field max_starts? integer initial postures tried, 20

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
---@field status string "solved", or what cannot be met
---@field solved boolean
---@field X_WH Transform of the palm
---@field q HandJoints
---@field tip_error number of the worst fingertip [m]
---@field cone_angle number between a distal axis and its inward normal, the largest [rad]
---@field clearance number least distance but at the contacts [m]; 0.02 if nothing is closer
---@field starts integer initial postures tried
---@field method string whose solution it is

---@class Transform
---@field p Vector3
---@field q number[] {w, x, y, z}

---Joint angles by the hand's own names [rad].
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
