-- A ruler lies flat on a table, its end a centimetre inboard of the edge. Nothing to get hold of:
-- only when about one centimetre of it stands over the edge can a hand close on it.
return scene {
  name = "ruler",
  object = {
    name = "ruler", shape = box{0.300, 0.030, 0.003}, mass = 0.025, friction = 0.3,
    p = {-0.160, 0, 0.0015},
  },
  environment = {
    -- The edge is the plane x = 0; the table's top is z = 0.
    { name = "table", shape = box{0.800, 0.600, 0.040}, friction = 0.3, p = {-0.400, 0, -0.020} },
  },
}
