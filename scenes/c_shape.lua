-- A C cut from 3 mm acrylic lies flat on a table, 1 cm inboard of the edge: not convex, and as hard to get
-- hold of as the ruler.
return scene {
  name = "c_shape",
  object = {
    name = "c", shape = mesh{"assets/objects/c_shape.obj"}, mass = 0.022, friction = 0.3, p = {-0.0524, 0, 0},
  },
  environment = {
    -- The edge is the plane x = 0; the table's top is z = 0.
    { name = "table", shape = box{0.500, 0.500, 0.040}, friction = 0.3, p = {-0.250, 0, -0.020} },
  },
}
