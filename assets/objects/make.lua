-- Writes the meshes of this folder: lua make.lua NAME > NAME.obj (or NAME.ply, for points). Any Lua from 5.1 on.
-- Lengths here are millimetres, in the files metres; +z is up, z = 0 is what the object stands on.

local V, F = {}, {}

local function vertex(x, y, z)
  V[#V + 1] = { x / 1000, y / 1000, z / 1000 }
  return #V
end

local function face(a, b, c) F[#F + 1] = { a, b, c } end

-- Two rings of equally many vertices, counter-clockwise from above, the second above or outside the first.
local function join(lower, upper)
  for i = 1, #lower do
    local j = i % #lower + 1
    face(lower[i], lower[j], upper[j])
    face(lower[i], upper[j], upper[i])
  end
end

-- A ring as a flat face that looks up, or down.
local function close(ring, up)
  for i = 2, #ring - 1 do
    if up then face(ring[1], ring[i], ring[i + 1]) else face(ring[1], ring[i + 1], ring[i]) end
  end
end

local function circle(r, z, sides)
  local ring = {}
  for i = 0, sides - 1 do
    local a = 2 * math.pi * i / sides
    ring[#ring + 1] = vertex(r * math.cos(a), r * math.sin(a), z)
  end
  return ring
end

-- A square with edges `size` and rounded corners.
local function square(size, corner, z)
  local ring, c, steps = {}, size / 2 - corner, 4
  for quarter = 0, 3 do
    for i = 0, steps do
      local a = math.pi / 2 * (quarter + i / steps)
      local sx = (quarter == 0 or quarter == 3) and 1 or -1
      local sy = quarter < 2 and 1 or -1
      ring[#ring + 1] = vertex(sx * c + corner * math.cos(a), sy * c + corner * math.sin(a), z)
    end
  end
  return ring
end

-- A profile {r, z}, ... about the z axis, from the axis below around the outside to the axis above.
local function turn(profile, sides)
  local last
  for _, point in ipairs(profile) do
    local ring = circle(point[1], point[2], sides)
    if last then join(last, ring) else close(ring, false) end
    last = ring
  end
  close(last, true)
end

local make = {}

-- A dinner plate: foot, well, and a rim whose underside stands 24 mm above the table at its edge.
function make.plate()
  local below = { { 75, 0 }, { 80, 5 }, { 97, 15 }, { 130, 24 } }
  local above = { { 131.5, 26 }, { 130, 28 }, { 97, 19 }, { 80, 9 }, { 75, 6 } }
  for _, point in ipairs(above) do below[#below + 1] = point end
  turn(below, 32)
end

-- A food container with vertical sides and a lid that is set back 2 mm, so that nothing stands out.
function make.container()
  local rings = {
    square(200, 20, 0), square(200, 20, 52), square(196, 18, 52), square(196, 18, 66), square(188, 14, 70),
  }
  close(rings[1], false)
  for i = 2, #rings do join(rings[i - 1], rings[i]) end
  close(rings[#rings], true)
end

-- A roll of receipt paper for a card terminal: 57 mm wide, 40 mm thick, with a 12 mm core that a plug of 5 mm
-- closes at its upper end.
function make.paper_roll() turn({ { 6, 52 }, { 6, 0 }, { 20, 0 }, { 20, 57 } }, 36) end

-- A C of 3 mm sheet, 120 mm wide, open towards +x.
function make.c_shape()
  local steps, outer, inner, h = 18, 60, 32, 3
  local sections = {}
  for i = steps, 0, -1 do
    local a = math.pi * (0.25 + 1.5 * i / steps)
    local x, y = math.cos(a), math.sin(a)
    sections[#sections + 1] = {
      vertex(inner * x, inner * y, 0), vertex(outer * x, outer * y, 0), vertex(outer * x, outer * y, h),
      vertex(inner * x, inner * y, h),
    }
  end
  close(sections[1], false)
  for i = 2, #sections do join(sections[i - 1], sections[i]) end
  close(sections[#sections], true)
end

-- Points of the same roll, 2 mm apart, with normals, as a scanner on all sides of it would give them.
local function points_of_roll()
  local points, step, r, core, h = {}, 2, 20, 6, 57
  local function add(radius, z, n_r, n_z)
    local count = math.max(8, math.floor(2 * math.pi * radius / step + 0.5))
    for i = 0, count - 1 do
      local a = 2 * math.pi * (i + 0.5 * (#points % 2)) / count
      local x, y = math.cos(a), math.sin(a)
      points[#points + 1] = ("%.6f %.6f %.6f %.5f %.5f %.5f"):format(
        radius * x / 1000, radius * y / 1000, z / 1000, n_r * x, n_r * y, n_z)
    end
  end
  for z = step / 2, h - step / 4, step do
    add(r, z, 1, 0)
    if z < h - 5 then add(core, z, -1, 0) end
  end
  for radius = step / 2, r - step / 4, step do
    add(radius, radius < core and h - 5 or 0, 0, -1)
    add(radius, h, 0, 1)
  end
  return points
end

local name = arg[1] or error "which mesh?"
if name == "paper_roll_points" then
  local points = points_of_roll()
  print "ply\nformat ascii 1.0"
  print("element vertex " .. #points)
  for _, property in ipairs { "x", "y", "z", "nx", "ny", "nz" } do print("property float " .. property) end
  print "end_header"
  for _, line in ipairs(points) do print(line) end
else
  make[name]()
  print("# " .. name .. ", written by make.lua")
  for _, v in ipairs(V) do print(("v %.6f %.6f %.6f"):format(v[1], v[2], v[3])) end
  for _, f in ipairs(F) do print(("f %d %d %d"):format(f[1], f[2], f[3])) end
end
